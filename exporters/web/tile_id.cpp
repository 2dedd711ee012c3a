// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/tile_id.hpp"

#include <utility>

namespace waymark::exporters {

std::uint64_t hilbert_of(const TileId& cell) {
  std::uint32_t x = cell.column, y = cell.row;
  std::uint64_t index = 0;
  for (std::uint32_t side = cell.zoom > 0 ? 1u << (cell.zoom - 1) : 0; side > 0; side >>= 1) {
    const std::uint32_t east = (x & side) != 0, south = (y & side) != 0;
    index = index << 2 | ((3 * east) ^ south);
    if (south) continue;  // the curve is turned in the two northern quadrants only
    if (east) {
      x = ~x;
      y = ~y;
    }
    std::swap(x, y);
  }
  return index;
}

std::uint64_t pmtiles_id(const TileId& tile) {
  const std::uint64_t coarser = ((std::uint64_t{1} << (2 * tile.zoom)) - 1) / 3;  // 1 + 4 + 16 + ...
  return coarser + hilbert_of(tile);
}

}  // namespace waymark::exporters
