// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
#include "core/locked_folder.hpp"
namespace waymark::exporters {

/// A hidden folder beside an output, on the same file system, where results are staged before they replace
/// older ones. The destructor removes what was not published, so a failure leaves older results unchanged.
class StagingFolder {
 public:
  /// Throws Error{output} if the output's folder is missing or not writable.
  explicit StagingFolder(const std::filesystem::path& output);

  const std::filesystem::path& path() const { return staged_->path(); }
  /// Flushes every file to the disk and renames it into the output's folder. Returns the new paths, sorted.
  /// Each file is replaced atomically, several files one after another; an older Shapefile with all its parts
  /// is removed first, and the new .shp comes last, so that parts of two runs never lie together.
  std::vector<std::filesystem::path> publish();

 private:
  std::filesystem::path folder_;
  std::optional<LockedFolder> staged_;
};

/// Returns whether the disk of `output` has so little space that it explains a failure.
bool disk_is_full(const std::filesystem::path& output);
[[noreturn]] void fail_full_disk(const std::filesystem::path& output);

/// Throws Error{output} for a result that could not be written. `reason` is the message of the system or a
/// library; a full disk is detected and reported instead of reason and hint.
[[noreturn]] void fail_output(
    const std::filesystem::path& output, const std::string& reason,
    const std::string& hint = "check that the folder can be written to, or write elsewhere");

/// Writes one file to a staging folder, flushes and renames it. Throws Error{output}.
void write_file(const std::filesystem::path& output, const std::string& content);

}  // namespace waymark::exporters
