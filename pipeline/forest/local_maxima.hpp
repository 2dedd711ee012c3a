// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include "core/grid.hpp"
namespace waymark::pipeline {

struct CellStep {
  int column, row;
};
/// Eight neighbours in row order: the first four precede the cell, the others follow it.
inline constexpr std::array<CellStep, 8> kNeighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

/// Marks the cells of a row, from `first` on, above which no neighbour is in the order of
/// pipeline/terrain/cell_order.hpp: of equal neighbours the earlier one is above. Cells outside the grid
/// and -infinity are above nothing; a cell of -infinity is no maximum.
void local_maxima(const Grid<float>& heights, std::int64_t first, std::int64_t row,
                  std::span<std::uint8_t> is_maximum);

}  // namespace waymark::pipeline
