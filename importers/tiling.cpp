// SPDX-License-Identifier: Apache-2.0
#include "importers/tiling.hpp"

#include <algorithm>
#include <cassert>

namespace waymark::importers {

std::vector<pipeline::Tile> tiles_of(std::int64_t columns, std::int64_t rows, std::int64_t side) {
  assert(side > 0);
  std::vector<pipeline::Tile> tiles;
  for (std::int64_t top = 0; top < rows; top += side)
    for (std::int64_t left = 0; left < columns; left += side)
      tiles.push_back({.index = static_cast<std::int64_t>(tiles.size()),
                       .column = left / side,
                       .row = top / side,
                       .cells = {left, top, std::min(side, columns - left), std::min(side, rows - top)}});
  return tiles;
}

}  // namespace waymark::importers
