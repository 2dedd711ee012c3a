// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
namespace waymark {

/// Results of a run without a work folder that are not worth the memory: what exceeds `in_memory` bytes goes
/// to a file without a name, so that nothing is left however the process ends. The file grows only, and is
/// gone with the ScratchFile. Thread-safe.
class ScratchFile {
 public:
  /// Empty folder: the system's for temporary files.
  ScratchFile(std::filesystem::path folder, std::size_t in_memory);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Gives back what reads the bytes, as often as it is called, while the ScratchFile lives. Throws
  /// Error{output} where the disk does not take them, the reader Error{input} where it does not give them.
  std::function<std::string()> put(std::string bytes);

 private:
  void open();

  std::filesystem::path folder_;
  std::size_t room_;  ///< bytes that may still stay in memory
  std::mutex mutex_;
  int file_ = -1;  ///< descriptor; -1 until it is needed
  std::uint64_t end_ = 0;
};

}  // namespace waymark
