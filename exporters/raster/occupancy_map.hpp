// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Writes a band of probabilities as a map of Nav2's map_server: a YAML file, and a PGM beside it with the
/// same stem. Mode `raw`: 0 to 100 are per cent, 255 is unknown (NaN). Reads a few rows at a time. Throws
/// Error{output}, and Error{input} for cells that are not square.
void write_occupancy_map(const std::filesystem::path& yaml, const std::filesystem::path& raster, int band);

/// Writes the areas of the classes of a band of whole numbers as polygons: a map without landmarks whose
/// layer has the columns `code`, `class` (text) and `area` (square CRS units). Cells of class 0 are left out.
/// `names` are those of class 0, 1, .... Throws Error{output}.
void write_class_polygons(const std::filesystem::path& map, const std::string& layer,
                          const std::filesystem::path& raster, int band, std::span<const char* const> names,
                          const Crs& crs);

}  // namespace waymark::exporters
