// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>
namespace waymark::inline core {

/// A folder PREFIX<process>-XXXXXX, removed with its content by the destructor. It is locked while the
/// process lives; the constructor removes those of dead processes in the same folder.
class LockedFolder {
 public:
  /// Throws std::filesystem::filesystem_error if the folder cannot be made.
  LockedFolder(const std::filesystem::path& parent, std::string_view prefix);
  ~LockedFolder();
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace waymark::inline core
