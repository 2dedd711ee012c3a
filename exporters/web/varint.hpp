// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark::exporters {

/// Appends a number in groups of seven bits, the lowest first (Protocol Buffers, PMTiles).
inline void append_varint(std::string& bytes, std::uint64_t value) {
  for (; value > 0x7f; value >>= 7) bytes += static_cast<char>(value | 0x80);
  bytes += static_cast<char>(value);
}

/// Returns a signed number as Protocol Buffers store it: 0, -1, 1, -2 become 0, 1, 2, 3.
inline std::uint64_t zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}

}  // namespace waymark::exporters
