// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/coarse_heights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace waymark::pipeline
