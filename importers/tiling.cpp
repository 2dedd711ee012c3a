// SPDX-License-Identifier: Apache-2.0
#include "importers/tiling.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace waymark::importers {
namespace {

/// Returns the bits of both numbers in turn.
std::uint64_t morton_code(std::int64_t column, std::int64_t row) {
  std::uint64_t code = 0;
  for (unsigned bit = 0; bit < 32; ++bit)
    code |= (static_cast<std::uint64_t>(column) >> bit & 1) << 2 * bit |
            (static_cast<std::uint64_t>(row) >> bit & 1) << (2 * bit + 1);
  return code;
}

}  // namespace

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

void rank_along_curve(std::vector<pipeline::Tile>& tiles) {
  std::vector<std::pair<std::uint64_t, pipeline::Tile*>> order;
  for (pipeline::Tile& tile : tiles) order.emplace_back(morton_code(tile.column, tile.row), &tile);
  std::ranges::sort(order);
  for (std::size_t rank = 0; rank < order.size(); ++rank)
    order[rank].second->rank = static_cast<std::int64_t>(rank);
}

}  // namespace waymark::importers
