// SPDX-License-Identifier: Apache-2.0
#include "core/output_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

#include "core/error.hpp"

namespace waymark::inline core {
namespace {

namespace fs = std::filesystem;

// Less than any output needs: with so little space left, the full disk explains a failure.
constexpr std::uintmax_t kFullDisk = 16 * 1024;

}  // namespace

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
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

void fail_output(const fs::path& output, int error_number) {
  if (error_number == ENOSPC || error_number == EDQUOT) fail_full_disk(output);
  fail_output(output, std::generic_category().message(error_number));
}

}  // namespace waymark::inline core
