// SPDX-License-Identifier: Apache-2.0
#include "exporters/aside_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "core/error.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

// Less than any output needs: a file system this empty of space is the cause of whatever went wrong.
constexpr std::uintmax_t kFullDisk = 16 * 1024;

std::string system_reason(int number) {
  return std::generic_category().message(number);
}

fs::path folder_of(const fs::path& output) {
  return output.has_parent_path() ? output.parent_path() : fs::path(".");
}

/// Late write errors (a full disk, a quota) are only seen here.
void flush(const fs::path& file, const fs::path& output) {
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) fail_output(output, system_reason(errno));
  const int failed = ::fsync(handle) == 0 ? 0 : errno;
  ::close(handle);
  if (failed != 0 && failed != EINVAL) fail_output(output, system_reason(failed));
}

}  // namespace

AsideFolder::AsideFolder(const fs::path& output) : folder_(folder_of(output)) {
  std::error_code ignored;
  if (!fs::is_directory(folder_, ignored))
    throw Error(ErrorCode::output,
                "cannot write " + output.filename().string() + ": its folder does not exist",
                folder_.string(), "make the folder, or write elsewhere");
  std::string pattern = (folder_ / ".waymark-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) fail_output(output, system_reason(errno));
  path_ = pattern;
}

AsideFolder::~AsideFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<fs::path> AsideFolder::publish() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path_)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (fs::path& file : files) {
    const fs::path output = folder_ / file.filename();
    if (fs::is_regular_file(file)) flush(file, output);
    std::error_code failed;
    if (fs::is_directory(file)) fs::remove_all(output, failed);  // a folder does not replace a folder
    fs::rename(file, output, failed);
    if (failed) fail_output(output, failed.message());
    file = output;
  }
  return files;
}

bool disk_is_full(const fs::path& output) {
  std::error_code unknown;
  const fs::space_info space = fs::space(folder_of(output), unknown);
  return !unknown && space.capacity > 0 && space.available < kFullDisk;  // /proc has no capacity
}

void fail_full_disk(const fs::path& output) {
  throw Error(ErrorCode::output, fmt::format("cannot write {}: the disk is full", output.filename().string()),
              output.string(), "free some space, or write to another disk; an older file is left as it was");
}

void fail_output(const fs::path& output, const std::string& reason, const std::string& hint) {
  if (disk_is_full(output)) fail_full_disk(output);
  throw Error(ErrorCode::output, fmt::format("cannot write {}: {}", output.filename().string(), reason),
              output.string(), hint);
}

void write_file(const fs::path& output, const std::string& content) {
  std::error_code ignored;
  if (fs::is_directory(output, ignored)) fail_output(output, "it is a folder");
  AsideFolder aside(output);
  std::ofstream file(aside.path() / output.filename(), std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) fail_output(output, system_reason(errno));
  aside.publish();
}

}  // namespace waymark
