// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "pipeline/engine/tile.hpp"
namespace waymark::importers {

/// Cuts a grid into squares of `side` > 0 cells, row by row from the top left. The last tile of a row and the
/// last row may be smaller.
std::vector<pipeline::Tile> tiles_of(std::int64_t columns, std::int64_t rows, std::int64_t side);

/// Ranks tiles along a curve through the plane (Morton 1966), so that those that run together read the same
/// blocks of a raster.
void rank_along_curve(std::vector<pipeline::Tile>& tiles);

}  // namespace waymark::importers
