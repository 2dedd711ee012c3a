// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
namespace waymark::geodb {

/// Error in a map file, found by validate_map().
struct Finding {
  std::string code;                 ///< stable, for scripts: "rtree.missing", "quality.range"
  std::string table;                ///< empty: the file as a whole
  std::optional<std::int64_t> row;  ///< primary key
  std::string text;                 ///< one sentence with the numbers
  friend bool operator==(const Finding&, const Finding&) = default;
};

/// Checks a map for errors that a GeoPackage validator does not detect (interface.md), and its RTree. Returns
/// at most 100 findings per code and table, then one that counts the others; empty if the map is valid. Never
/// writes. Throws Error if the file cannot be opened as a map.
std::vector<Finding> validate_map(const std::filesystem::path& path);

/// Throws Error{input} with the first finding if a landmark has impossible numbers: a table, report or page
/// made from the map would be wrong. Other faults do not matter to readers. 2 us per landmark.
void check_before_reading(const std::filesystem::path& map);

/// Throws Error{input} with the first finding if a map has errors: a map made from it would have them, too.
void check_before_copy(const std::filesystem::path& map);

}  // namespace waymark::geodb
