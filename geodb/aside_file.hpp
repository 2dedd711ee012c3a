// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark {

/// A file written beside its final place and moved there when it is whole: readers see the old file or the
/// new one, never a part. Without keep() it vanishes. What a killed process left behind is removed by the
/// next one that writes the same file: a living writer holds a lock (flock) on its own.
class AsideFile {
 public:
  /// Makes an empty file ".<name>.<process>-<number>.part" in the folder of `final_path`.
  /// Throws Error where the folder is missing or cannot be written.
  explicit AsideFile(std::filesystem::path final_path);
  ~AsideFile();
  AsideFile(const AsideFile&) = delete;
  AsideFile& operator=(const AsideFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Flushes the file to the disk, renames it, and flushes the folder. Throws Error.
  void keep();

 private:
  std::filesystem::path final_path_, path_;
  int lock_ = -1;  ///< file descriptor
};

}  // namespace waymark
