// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "pipeline/engine/tile.hpp"
namespace waymark {

/// Cuts a grid into squares of `side` cells, row by row from the top left; the last of a row and the last row
/// may be smaller. `side` > 0.
std::vector<Tile> tiles_of(std::int64_t columns, std::int64_t rows, std::int64_t side);

}  // namespace waymark
