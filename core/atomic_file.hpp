// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>
#include "core/error.hpp"
#include "core/locked_folder.hpp"
namespace waymark::inline core {

/// One output that replaces an older one atomically: readers see the old file or the new one, never a part.
/// - It is written in a hidden, locked folder beside the output (LockedFolder), so that a library may keep
///   journals and temporary files beside it. The destructor removes the folder, and the next output in the
///   same place removes those of dead processes.
/// - A symbolic link is followed. An older file's permissions are retained.
/// - An output that is a pipe or a device receives the bytes when they are complete.
class AtomicFile {
 public:
  /// Throws Error{output} if the output's folder is missing or not writable, or the output is a folder.
  explicit AtomicFile(const std::filesystem::path& output);

  /// Returns the path to write, with the output's file name; nothing is there yet.
  const std::filesystem::path& path() const { return path_; }
  /// Returns the path that is replaced: the output, or the file that it links to.
  const std::filesystem::path& target() const { return target_; }
  /// Flushes the file to the disk, renames it, and flushes the folder. Throws Error{output}.
  void commit();

 private:
  std::filesystem::path output_, target_;  ///< `target_`: `output_` without symbolic links
  bool is_stream_;                         ///< a pipe or a device
  LockedFolder aside_;
  std::filesystem::path path_;
};

/// Several files, or folders of files, that replace older ones together. Files are renamed one after another,
/// but the commit is journaled: if the process is killed within, the next output in the folder finishes it.
/// - Folders are merged with existing ones of the same name, but a folder *.gdb is one data set.
/// - An older Shapefile or MapInfo file is removed with all its parts first, and its main file comes last.
///   Readers never see parts of two data sets.
class AtomicFileSet {
 public:
  /// `folder`: where the files go. Throws Error{output} if it is missing or not writable; `output` is what
  /// messages name.
  AtomicFileSet(std::filesystem::path folder, std::filesystem::path output);

  /// Returns the empty folder to write to.
  const std::filesystem::path& path() const { return path_; }
  /// Flushes all files to the disk and moves them. Returns the new paths, sorted. Throws Error{output},
  /// before anything has changed if one of the files cannot be replaced.
  std::vector<std::filesystem::path> commit();

 private:
  std::filesystem::path folder_, output_;
  LockedFolder aside_;
  std::filesystem::path path_;
};

/// Returns an error of a path that is aside with the final path instead.
Error with_final_path(const Error& error, const std::filesystem::path& aside,
                      const std::filesystem::path& final_path);

/// Writes a text or bytes as an AtomicFile. Throws Error{output}.
void write_file(const std::filesystem::path& output, std::string_view content);

/// Writes a file in place, unflushed: for files that are aside already. Returns 0, or the errno of a failure.
int write_aside(const std::filesystem::path& file, std::string_view content);

}  // namespace waymark::inline core
