// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>
namespace waymark::exporters {

/// Consecutive tiles of equal content, or a leaf directory if `run` is 0.
struct PmtilesEntry {
  std::uint64_t id = 0;      ///< of the first tile
  std::uint64_t offset = 0;  ///< in the section of tiles, or of leaf directories
  std::uint32_t length = 0;  ///< bytes, > 0
  std::uint32_t run = 1;     ///< number of tiles
  friend bool operator==(const PmtilesEntry&, const PmtilesEntry&) = default;
};

/// Directories of an archive, both compressed by gzip.
struct PmtilesDirectories {
  std::string root, leaves;
};

/// Returns one directory (PMTiles 3, section 4), not compressed.
std::string encode_directory(std::span<const PmtilesEntry> entries);

/// Divides entries, ascending by id, into a root directory of at most `max_root` bytes and leaf directories;
/// without leaves if the root can hold all.
PmtilesDirectories make_directories(const std::vector<PmtilesEntry>& entries, std::size_t max_root);

}  // namespace waymark::exporters
