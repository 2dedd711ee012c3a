// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/store/atomic_file.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::string_view kPrefix = ".part-";

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// Returns the process of this machine that created a name of temporary_path, else 0.
pid_t local_owner(std::string_view name) {
  const std::string suffix = "-" + host_name();
  if (!name.starts_with(kPrefix) || !name.ends_with(suffix)) return 0;
  pid_t process = 0;
  std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), process);
  return process;
}

bool is_gone(pid_t process) {
  return kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

std::filesystem::path temporary_path(const std::filesystem::path& folder) {
  static std::atomic<int> counter = 0;
  return folder / fmt::format("{}{}-{}-{}", kPrefix, getpid(), counter++, host_name());
}

void remove_stale_files(const std::filesystem::path& folder) {
  std::error_code ignored;  // another process may be cleaning the same folder
  for (std::filesystem::directory_iterator entry(folder, ignored), end; entry != end;
       entry.increment(ignored)) {
    const pid_t owner = local_owner(entry->path().filename().string());
    if (owner > 0 && is_gone(owner)) std::filesystem::remove_all(entry->path(), ignored);
  }
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
    throw Error(ErrorCode::output, std::string("cannot write into the work folder: ") + std::strerror(errno),
                path.string(),
                "free some space or choose another folder with --work; finished results are kept");
}

std::string read_file(const std::filesystem::path& path) {
  return read_text(path, "from the work folder", ErrorCode::input, "run again: missing results are computed");
}

}  // namespace waymark::pipeline
