// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
namespace waymark::pipeline {

/// Temporary storage for results of a run without a work folder. Thread-safe.
/// The first `in_memory` bytes stay in memory; the rest goes to a nameless file that disappears with the
/// ScratchFile, even if the process is killed. The file only grows.
class ScratchFile {
 public:
  /// `folder` empty: the system's folder for temporary files.
  ScratchFile(std::filesystem::path folder, std::size_t in_memory);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Stores bytes and returns a function that reads them, valid while the ScratchFile lives.
  /// Throws Error{output} if the disk is full; the reader throws Error{input} if reading fails.
  std::function<std::string()> put(std::string bytes);

 private:
  void open();

  std::filesystem::path folder_;
  std::size_t room_;  ///< bytes that may still stay in memory
  std::mutex mutex_;
  int file_ = -1;  ///< descriptor; -1 until it is needed
  std::uint64_t end_ = 0;
};

}  // namespace waymark::pipeline
