// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Bands of a raster, counted from 1, that a map for navigation is made of.
struct OccupancyBands {
  int probability = 1, classes = 2;
  int lethal_class = 2, unknown_class = 3;
};

/// Writes a raster as a map of Nav2's map_server: a YAML file, and a PGM beside it with the same stem.
/// - Mode `raw`. Cells of the lethal class are 100, those of the unknown class 255, others their probability
///   (0 to 1) in per cent, at most 99. By default, costmaps of Nav2 take 100 alone for an obstacle.
/// - Positions are those of the raster's CRS in metres. A comment names the CRS, and the factor of another
///   unit.
/// - Reads a row at a time. Throws Error{output}, and Error{input} for cells that are not square.
void write_occupancy_map(const std::filesystem::path& yaml, const std::filesystem::path& raster,
                         const OccupancyBands& bands, const Crs& crs);

/// Writes the areas of the classes of a band of whole numbers as polygons: a map without landmarks whose
/// layer has the columns `code`, `class` (text) and `area` (square CRS units). Cells of class 0 are left out.
/// `names` are those of class 0, 1, .... Throws Error{output}.
void write_class_polygons(const std::filesystem::path& map, const std::string& layer,
                          const std::filesystem::path& raster, int band, std::span<const char* const> names,
                          const Crs& crs);

}  // namespace waymark::exporters
