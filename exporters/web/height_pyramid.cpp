// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/height_pyramid.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::exporters {
namespace {

Grid<float> halved(const Grid<float>& fine) {
  Grid<float> coarse((fine.columns() + 1) / 2, (fine.rows() + 1) / 2);
  for (std::int64_t row = 0; row < coarse.rows(); ++row)
    for (std::int64_t column = 0; column < coarse.columns(); ++column) {
      double sum = 0;
      int known = 0;
      for (std::int64_t r = 2 * row; r < std::min(2 * row + 2, fine.rows()); ++r)
        for (std::int64_t c = 2 * column; c < std::min(2 * column + 2, fine.columns()); ++c)
          if (const float height = fine(c, r); !std::isnan(height)) {
            sum += height;
            ++known;
          }
      coarse(column, row) = static_cast<float>(sum / known);  // NaN where none is known
    }
  return coarse;
}

}  // namespace

HeightPyramid::HeightPyramid(Grid<float> heights) {
  levels_.push_back(std::move(heights));
  while (levels_.back().columns() > 1 || levels_.back().rows() > 1) levels_.push_back(halved(levels_.back()));
  for (std::size_t n = levels_.size() - 1; n-- > 0;)
    for (std::int64_t row = 0; row < levels_[n].rows(); ++row)
      for (std::int64_t column = 0; column < levels_[n].columns(); ++column)
        if (float& height = levels_[n](column, row); std::isnan(height))
          height = levels_[n + 1](column / 2, row / 2);
}

float HeightPyramid::at(int level, double column, double row) const {
  const Grid<float>& heights = levels_[static_cast<std::size_t>(level)];
  const double c = std::clamp(std::ldexp(column, -level) - 0.5, 0.0, double(heights.columns() - 1));
  const double r = std::clamp(std::ldexp(row, -level) - 0.5, 0.0, double(heights.rows() - 1));
  const auto west = static_cast<std::int64_t>(c), north = static_cast<std::int64_t>(r);
  const std::int64_t east = std::min(west + 1, heights.columns() - 1),
                     south = std::min(north + 1, heights.rows() - 1);
  const double u = c - double(west), v = r - double(north);
  return static_cast<float>((1 - v) * ((1 - u) * heights(west, north) + u * heights(east, north)) +
                            v * ((1 - u) * heights(west, south) + u * heights(east, south)));
}

}  // namespace waymark::exporters
