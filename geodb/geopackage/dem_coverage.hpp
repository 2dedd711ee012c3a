// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Stores a DEM as the gridded coverage `dem`: tiles of 256 x 256 cells, float32 metres, with coarser levels
/// up to a single tile.
/// - Cells of coarser levels are the mean of the known cells of each 2 x 2. Tiles without heights are
///   omitted.
/// - Tiles are read one at a time; memory does not depend on the size of the DEM.
/// - `srs_id` must be the CRS of the grid.
void write_dem_coverage(const sqlite::Database& database, const DemSource& dem, std::int32_t srs_id,
                        std::string_view changed);

/// Encodes one band of 32-bit floats as an uncompressed, single-strip, little-endian TIFF 6.0, the tile
/// format of the coverage extension.
std::vector<std::byte> float_tiff(const Grid<float>& cells);

}  // namespace waymark::geodb
