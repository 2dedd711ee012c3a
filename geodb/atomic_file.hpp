// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark::geodb {

/// Temporary file that replaces its target atomically: readers see the old file or the new one, never a part.
/// The destructor removes it unless commit() was called. Writers lock their file (flock), and remove unlocked
/// files of killed writers of the same target.
class AtomicFile {
 public:
  /// Creates an empty file ".<name>.<process>-<number>.part" in the folder of `final_path`.
  /// Throws Error if the folder is missing or cannot be written.
  explicit AtomicFile(std::filesystem::path final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Flushes the file to the disk, renames it, and flushes the folder. Throws Error if one of these fails.
  void commit();

 private:
  std::filesystem::path final_path_, path_;
  int lock_ = -1;  ///< file descriptor
};

}  // namespace waymark::geodb
