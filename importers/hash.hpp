// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark {

struct FileHash {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits, lower case
};

/// SHA-256 (FIPS 180-4) of a file, `/vsi...` paths included, read in pieces: about 400 MB/s, 1 MiB of memory.
/// A VRT stands for its sources too: their bytes and hashes, in the order GDAL lists them, follow its own.
/// Throws Error{input} where a file cannot be read.
FileHash hash_file(const std::string& path);

}  // namespace waymark
