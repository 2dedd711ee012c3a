// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
namespace waymark {

/// A hidden folder beside an output, on the same file system, in which results are written before they take
/// their place. What is still in it when the object dies is removed: a failure leaves older results as they
/// were.
class AsideFolder {
 public:
  /// Throws Error{output} where the output's folder is missing or cannot be written to.
  explicit AsideFolder(const std::filesystem::path& output);
  ~AsideFolder();
  AsideFolder(const AsideFolder&) = delete;
  AsideFolder& operator=(const AsideFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Flushes every file to the disk and renames it into the output's folder, sorted by name; returns the new
  /// paths. Each file is replaced as a whole; several files are not replaced at one instant.
  std::vector<std::filesystem::path> publish();

 private:
  std::filesystem::path folder_, path_;
};

/// So little space is left where `output` would be that this is the cause of whatever failed.
bool disk_is_full(const std::filesystem::path& output);
[[noreturn]] void fail_full_disk(const std::filesystem::path& output);

/// Error{output} for a result that could not be written. `reason` is what the system or a library said; a
/// full disk is recognised by itself, whatever the reason and hint.
[[noreturn]] void fail_output(
    const std::filesystem::path& output, const std::string& reason,
    const std::string& hint = "check that the folder can be written to, or write elsewhere");

/// Writes one file aside, flushes and renames it. Throws Error{output}.
void write_file(const std::filesystem::path& output, const std::string& content);

}  // namespace waymark
