// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
namespace waymark {

struct WriteMapOptions {
  bool replace = true;  ///< false: an existing file is an error
  /// Types that get a table though they have no landmark. A map without any landmark and without this gets a
  /// table for every type of the contents.
  std::vector<std::string> empty_tables = {};
  /// Of landmarks in parts so many are held together, and one part. The map does not
  /// depend on it.
  std::size_t landmarks_at_once = 100'000;
};

/// Writes a map as a GeoPackage 1.3 (tables: geodb/sql/schema.sql, docs of interface.md).
/// Rows lie along a Hilbert curve and the RTree is packed: 5 us of processor time per landmark with ten
/// features, and box queries touch few pages. Memory: about 60 bytes per landmark and 90 per shape above the
/// contents; what the contents give in parts and shapes made while they are written take none for long. The
/// file is written aside in the same folder in one transaction, flushed and renamed, so `path` is always the
/// old map or the new one, whole. The same contents give the same bytes. Throws Error: a folder that is
/// missing or cannot be written, a full disk, an existing file that may not be replaced, a uid that is empty
/// or used twice in a type, a position that is not finite, evidence for a landmark that is not there. The old
/// map is kept then. Returns how many landmarks of which type it wrote.
std::map<std::string, std::int64_t> write_map(const std::filesystem::path& path, const MapContents& contents,
                                              const WriteMapOptions& options = {});

}  // namespace waymark
