// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>
namespace waymark::inline core {

/// Prefix of every hidden file or folder that Waymark keeps beside an output or in the temporary folder.
inline constexpr std::string_view kAsidePrefix = ".waymark-";

/// Removes the locked folders of dead processes in a folder, as the constructor of LockedFolder does.
void remove_dead_folders(const std::filesystem::path& parent,
                         const std::function<void(const std::filesystem::path& dead)>& before_removal = {});

/// Removes the locked folders of this process that are not abandoned: for the end by a signal, which calls no
/// destructors.
void remove_own_folders() noexcept;

/// A folder .waymark-<process>-<host>-XXXXXX, removed with its content by the destructor. It is locked while
/// the process lives; the constructor removes those of dead processes in the same folder.
class LockedFolder {
 public:
  /// Calls `before_removal` with each folder of a dead process, which is kept if it throws.
  /// Throws std::filesystem::filesystem_error if the folder cannot be made.
  explicit LockedFolder(const std::filesystem::path& parent,
                        const std::function<void(const std::filesystem::path& dead)>& before_removal = {});
  ~LockedFolder();
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Leaves the folder to the next process that makes one in the same parent.
  void abandon();
  /// Lets the destructor remove the folder again.
  void reclaim();

 private:
  bool is_abandoned() const;

  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace waymark::inline core
