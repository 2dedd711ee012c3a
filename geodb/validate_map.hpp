// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
namespace waymark {

/// A promise a map file breaks.
struct Finding {
  std::string code;                 ///< stable, for scripts: "rtree.missing", "quality.range"
  std::string table;                ///< empty: the file as a whole
  std::optional<std::int64_t> row;  ///< primary key
  std::string text;                 ///< one sentence with the numbers
  friend bool operator==(const Finding&, const Finding&) = default;
};

/// Checks the promises of interface.md that a GeoPackage validator does not know, and the RTree.
/// At most 100 findings per code and table, then one that counts the rest. Empty: the map is
/// sound. Never writes. Throws Error where the file cannot be opened as a map at all.
std::vector<Finding> validate_map(const std::filesystem::path& path);

}  // namespace waymark
