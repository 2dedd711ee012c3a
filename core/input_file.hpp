// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark::inline core {

/// File that a run has read, with the hash that identifies its content.
struct InputFile {
  std::string path;  ///< as the user gave it; may be a /vsi path
  std::uint64_t bytes = 0;
  std::string sha256;  ///< of its content, 64 lower-case hexadecimal digits
  friend bool operator==(const InputFile&, const InputFile&) = default;
};

}  // namespace waymark::inline core
