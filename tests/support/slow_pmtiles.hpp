// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <variant>
#include <vector>
namespace waymark::test {

/// Tile by zoom, column and row.
using TileKey = std::tuple<int, std::uint32_t, std::uint32_t>;

/// Archive of tiles, read by the letter of the PMTiles specification, version 3, and nothing shared with the
/// writer. All checks are expectations of gtest.
struct SlowArchive {
  std::map<TileKey, std::string> tiles;  ///< content as stored
  std::string metadata;
  std::map<std::string, std::uint64_t> header;      ///< numbers by the names of the specification
  double west = 0, south = 0, east = 0, north = 0;  ///< bounds, degrees
  std::size_t leaves = 0;                           ///< leaf directories
};
SlowArchive read_archive(const std::string& file_content);

std::string gunzip(const std::string& content);

/// Returns the cells of a grid of 2^order per side in the order of the Hilbert curve, by its definition: four
/// copies of the curve of half the size, the first and the last one turned.
std::vector<std::pair<std::uint32_t, std::uint32_t>> draw_hilbert(int order);

struct TileFeature {
  std::uint64_t id = 0;
  std::int64_t x = 0, y = 0;                                              ///< of a point
  std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> rings;  ///< of a polygon
  std::map<std::string, std::variant<double, std::string>> properties;
};
/// Features of a vector tile, not compressed, by layer: points and polygons.
std::map<std::string, std::vector<TileFeature>> read_vector_tile(const std::string& message);

}  // namespace waymark::test
