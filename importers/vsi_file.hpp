// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
namespace waymark::importers {

/// A file at any path GDAL knows (`/vsizip/...`), open for reading. One thread at a time may use it.
class VsiFile {
 public:
  /// Throws Error{input} if the file does not exist.
  explicit VsiFile(const std::string& path);
  ~VsiFile();
  VsiFile(const VsiFile&) = delete;
  VsiFile& operator=(const VsiFile&) = delete;

  /// Reads up to `count` bytes from `offset`; returns fewer only at the end of the file.
  std::size_t read(std::uint64_t offset, void* into, std::size_t count);
  std::uint64_t size();

 private:
  void* file_;
};

}  // namespace waymark::importers
