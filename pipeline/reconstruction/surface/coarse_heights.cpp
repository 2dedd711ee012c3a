// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/coarse_heights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace waymark::pipeline {

double CoarseHeights::at(double x, double y) const {
  const double c = grid.column(x), r = grid.row(y);
  if (!(c >= 0 && r >= 0 && c <= double(grid.columns - 1) && r <= double(grid.rows - 1)))
    return std::numeric_limits<double>::quiet_NaN();
  const auto i = std::min(static_cast<std::int64_t>(c), grid.columns - 2),
             j = std::min(static_cast<std::int64_t>(r), grid.rows - 2);
  if (i < 0 || j < 0) return std::numeric_limits<double>::quiet_NaN();
  const double a = c - double(i), b = r - double(j);
  return (1 - b) * ((1 - a) * double(heights(i, j)) + a * double(heights(i + 1, j))) +
         b * ((1 - a) * double(heights(i, j + 1)) + a * double(heights(i + 1, j + 1)));
}

CoarseHeights with_cell(const CoarseHeights& dem, double cell) {
  CoarseHeights out = dem;
  while (out.grid.cell * 2 <= cell) {  // means first, so that no detail is aliased
    CoarseHeights half = out;
    half.grid = {.west = out.grid.west,
                 .north = out.grid.north,
                 .cell = 2 * out.grid.cell,
                 .columns = out.grid.columns / 2,
                 .rows = out.grid.rows / 2};
    half.heights = Grid<float>(half.grid.columns, half.grid.rows);
    for (std::int64_t r = 0; r < half.grid.rows; ++r)
      for (std::int64_t c = 0; c < half.grid.columns; ++c)
        half.heights(c, r) = (out.heights(2 * c, 2 * r) + out.heights(2 * c + 1, 2 * r) +
                              out.heights(2 * c, 2 * r + 1) + out.heights(2 * c + 1, 2 * r + 1)) /
                             4;
    out = std::move(half);
  }
  const SurfaceGrid to = out.grid.with_cell(cell);
  out.heights = resample(out.heights, out.grid, to);
  out.grid = to;
  return out;
}

}  // namespace waymark::pipeline
