// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
namespace waymark::geodb {

/// Options of write_map().
struct WriteMapOptions {
  bool replace = true;  ///< false: an existing file is an error
  /// Types that get a table although they have no landmarks. A map without landmarks gets a table for every
  /// type of the contents if this is empty.
  std::vector<std::string> empty_tables = {};
  /// Number of landmarks of parts that are in memory at once, besides one part. Does not affect the map.
  std::size_t max_landmarks_in_memory = 100'000;
};

/// Writes a map as a GeoPackage 1.3 (tables: geodb/sql/schema.sql). Returns the number of landmarks by type.
/// - Atomic: the file is written in the same folder in one transaction, flushed and renamed.
/// - Deterministic: equal contents give equal bytes.
/// - Rows are in Hilbert order and the RTree is packed, so that box queries read few pages.
/// - Costs 5 us of processor time per landmark with ten features. Memory: about 60 bytes per landmark and 90
///   per shape in addition to the contents; none for parts and generated shapes.
/// - Throws Error, and leaves an old map unchanged, for: a folder that is missing or not writable; a full
///   disk; an existing file that may not be replaced; an empty or duplicate uid; a position that is not
///   finite; an observation of a missing landmark.
std::map<std::string, std::int64_t> write_map(const std::filesystem::path& path, const MapContents& contents,
                                              const WriteMapOptions& options = {});

}  // namespace waymark::geodb
