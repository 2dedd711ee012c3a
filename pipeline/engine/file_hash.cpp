// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/file_hash.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/error.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::pipeline {

InputFile hash_plain_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Sha256 sum;
  InputFile measured{.path = path, .bytes = 0, .sha256 = {}};
  std::vector<char> block(1 << 20);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    sum.add({block.data(), count});
    measured.bytes += count;
  }
  if (!file.eof())
    throw Error(ErrorCode::input, std::string("cannot read an input file: ") + std::strerror(errno), path,
                "check the path in the job; it is relative to the job file");
  measured.sha256 = sum.hex();
  return measured;
}

}  // namespace waymark::pipeline
