// SPDX-License-Identifier: Apache-2.0
#include "exporters/staging_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "core/error.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

// Less than any output needs: with so little space left, the full disk explains a failure.
constexpr std::uintmax_t kFullDisk = 16 * 1024;
constexpr const char* kFolderPrefix = ".waymark-";

std::string system_reason(int number) {
  return std::generic_category().message(number);
}

fs::path folder_of(const fs::path& output) {
  return output.has_parent_path() ? output.parent_path() : fs::path(".");
}

/// Files that carry one data set together with a main file of the same stem. Readers open the main file.
struct FileFamily {
  std::string_view main;
  std::vector<std::string_view> others;
};

const std::vector<FileFamily>& file_families() {
  static const std::vector<FileFamily> all = {
      {".shp", {".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn", ".sbx", ".idm", ".ind", ".qpj", ".shp.xml"}},
      {".tab", {".dat", ".map", ".id", ".ind"}},
      {".mif", {".mid"}}};
  return all;
}

bool is_main_file(const fs::path& file) {
  return std::ranges::find(file_families(), file.extension().string(), &FileFamily::main) !=
         file_families().end();
}

/// Removes an older data set, the main file first: if the program is killed while the new parts move to their
/// place, there is no main file rather than parts of two runs.
void remove_parts(const fs::path& main) {
  const auto family = std::ranges::find(file_families(), main.extension().string(), &FileFamily::main);
  std::error_code ignored;  // a part that cannot be removed cannot be replaced either, which fails below
  fs::remove(main, ignored);
  for (const std::string_view other : family->others)
    fs::remove(fs::path(main).replace_extension(other), ignored);
}

/// Reveals late write errors (a full disk, a quota).
void flush(const fs::path& file, const fs::path& output) {
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) fail_output(output, system_reason(errno));
  const int failed = ::fsync(handle) == 0 ? 0 : errno;
  ::close(handle);
  if (failed != 0 && failed != EINVAL) fail_output(output, system_reason(failed));
}

}  // namespace

StagingFolder::StagingFolder(const fs::path& output) : folder_(folder_of(output)) {
  std::error_code ignored;
  if (!fs::is_directory(folder_, ignored))
    throw Error(ErrorCode::output,
                "cannot write " + output.filename().string() + ": its folder does not exist",
                folder_.string(), "create the folder, or write elsewhere");
  try {
    staged_.emplace(folder_, kFolderPrefix);
  } catch (const fs::filesystem_error& error) {
    fail_output(output, error.code().message());
  }
}

std::vector<fs::path> StagingFolder::publish() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::ranges::stable_partition(files, [](const fs::path& file) { return !is_main_file(file); });
  for (const fs::path& file : files)
    if (is_main_file(file)) remove_parts(folder_ / file.filename());
  for (fs::path& file : files) {
    const fs::path output = folder_ / file.filename();
    if (fs::is_regular_file(file)) flush(file, output);
    std::error_code failed;
    if (fs::is_directory(file))
      fs::remove_all(output, failed);  // rename() cannot replace a folder by a folder
    fs::rename(file, output, failed);
    if (failed) fail_output(output, failed.message());
    file = output;
  }
  std::ranges::sort(files);
  return files;
}

bool disk_is_full(const fs::path& output) {
  std::error_code unknown;
  const fs::space_info space = fs::space(folder_of(output), unknown);
  return !unknown && space.capacity > 0 && space.available < kFullDisk;  // /proc has no capacity
}

void fail_full_disk(const fs::path& output) {
  throw Error(ErrorCode::output, fmt::format("cannot write {}: the disk is full", output.filename().string()),
              output.string(), "free some space, or write to another disk; an older file is unchanged");
}

void fail_output(const fs::path& output, const std::string& reason, const std::string& hint) {
  if (disk_is_full(output)) fail_full_disk(output);
  throw Error(ErrorCode::output, fmt::format("cannot write {}: {}", output.filename().string(), reason),
              output.string(), hint);
}

void write_file(const fs::path& output, const std::string& content) {
  std::error_code ignored;
  if (fs::is_directory(output, ignored)) fail_output(output, "it is a folder");
  StagingFolder staging(output);
  std::ofstream file(staging.path() / output.filename(), std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) fail_output(output, system_reason(errno));
  staging.publish();
}

}  // namespace waymark::exporters
