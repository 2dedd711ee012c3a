// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include "core/grid.hpp"
namespace waymark {

struct CellStep {
  int column, row;
};
/// The eight neighbours in row order: the first four come before the cell, the others after it.
inline constexpr std::array<CellStep, 8> kAround{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

/// Which cells of a row, from `first` on, no neighbour stands above in the order of
/// pipeline/terrain/cell_order.hpp: equal neighbours that come before stand above. Cells outside the grid and
/// -infinity stand above nothing; a cell of -infinity is no maximum.
void local_maxima(const Grid<float>& heights, std::int64_t first, std::int64_t row,
                  std::span<std::uint8_t> is_maximum);

}  // namespace waymark
