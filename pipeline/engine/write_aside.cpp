// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/write_aside.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/error.hpp"

namespace waymark {
namespace {

constexpr std::string_view kPrefix = ".part-";

std::string machine() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// The process that a name of aside_path belongs to if it ran on this machine, else 0.
pid_t local_maker(std::string_view name) {
  const std::string suffix = "-" + machine();
  if (!name.starts_with(kPrefix) || !name.ends_with(suffix)) return 0;
  pid_t process = 0;
  std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), process);
  return process;
}

bool is_gone(pid_t process) {
  return kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

std::filesystem::path aside_path(const std::filesystem::path& folder) {
  static std::atomic<int> counter = 0;
  return folder / fmt::format("{}{}-{}-{}", kPrefix, getpid(), counter++, machine());
}

void remove_leftovers(const std::filesystem::path& folder) {
  std::error_code ignored;  // another process may be tidying the same folder
  for (std::filesystem::directory_iterator entry(folder, ignored), end; entry != end;
       entry.increment(ignored)) {
    const pid_t maker = local_maker(entry->path().filename().string());
    if (maker > 0 && is_gone(maker)) std::filesystem::remove_all(entry->path(), ignored);
  }
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
    throw Error(ErrorCode::output, std::string("cannot write into the work folder: ") + std::strerror(errno),
                path.string(), "make room or choose another folder with --work; what is done is kept");
}

std::string read_file(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = file.tellg();
  std::string bytes(size < 0 ? 0 : static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file || size < 0)
    throw Error(ErrorCode::input, std::string("cannot read from the work folder: ") + std::strerror(errno),
                path.string(), "run again: what is missing is made anew");
  return bytes;
}

}  // namespace waymark
