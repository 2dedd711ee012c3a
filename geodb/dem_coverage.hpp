// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
#include "geodb/sqlite.hpp"
namespace waymark {

/// Stores a DEM as the gridded coverage `dem`: 256 x 256 cells per tile, float32 metres, with coarser levels
/// (mean of the known cells of each 2 x 2) down to a single tile. Tiles without any height are left out.
/// Reads one tile at a time; memory does not depend on the DEM. The grid must be in the CRS `srs_id` stands
/// for.
void write_dem_coverage(const sqlite::Database& database, const DemSource& dem, std::int32_t srs_id,
                        std::string_view changed);

/// One band of 32-bit floats as an uncompressed, single-strip, little-endian TIFF 6.0: what the coverage
/// extension asks of a tile.
std::vector<std::byte> float_tiff(const Grid<float>& cells);

}  // namespace waymark
