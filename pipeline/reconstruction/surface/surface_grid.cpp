// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/surface_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace waymark::pipeline {
namespace {

// Means of the known cells of 2 x 2; NaN if none is known.
Grid<float> reduced(const Grid<float>& heights) {
  Grid<float> half((heights.columns() + 1) / 2, (heights.rows() + 1) / 2,
                   std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t r = 0; r < half.rows(); ++r)
    for (std::int64_t c = 0; c < half.columns(); ++c) {
      double sum = 0;
      int known = 0;
      for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
        if (heights.contains(2 * c + i, 2 * r + j) && !std::isnan(heights(2 * c + i, 2 * r + j)))
          sum += static_cast<double>(heights(2 * c + i, 2 * r + j)), ++known;
      if (known > 0) half(c, r) = static_cast<float>(sum / known);
    }
  return half;
}

}  // namespace

SurfaceGrid SurfaceGrid::with_cell(double size) const {
  SurfaceGrid other = *this;
  other.cell = size;
  other.columns = static_cast<std::int64_t>(std::ceil(static_cast<double>(columns) * cell / size - 1e-9));
  other.rows = static_cast<std::int64_t>(std::ceil(static_cast<double>(rows) * cell / size - 1e-9));
  return other;
}

Grid<float> resample(const Grid<float>& heights, const SurfaceGrid& from, const SurfaceGrid& to) {
  Grid<float> out(to.columns, to.rows);
  for (std::int64_t r = 0; r < to.rows; ++r) {
    const double v =
        std::clamp(from.row(to.y(static_cast<double>(r))), 0.0, static_cast<double>(from.rows - 1));
    const auto j = std::min(static_cast<std::int64_t>(v), std::max<std::int64_t>(from.rows - 2, 0));
    const std::int64_t j1 = std::min(j + 1, from.rows - 1);
    const double b = v - static_cast<double>(j);
    for (std::int64_t c = 0; c < to.columns; ++c) {
      const double u =
          std::clamp(from.column(to.x(static_cast<double>(c))), 0.0, static_cast<double>(from.columns - 1));
      const auto i = std::min(static_cast<std::int64_t>(u), std::max<std::int64_t>(from.columns - 2, 0));
      const std::int64_t i1 = std::min(i + 1, from.columns - 1);
      const double a = u - static_cast<double>(i);
      const auto h = [&](std::int64_t column, std::int64_t row) {
        return static_cast<double>(heights(column, row));
      };
      out(c, r) = static_cast<float>((1 - b) * ((1 - a) * h(i, j) + a * h(i1, j)) +
                                     b * ((1 - a) * h(i, j1) + a * h(i1, j1)));
    }
  }
  return out;
}

Grid<float> fill_gaps(const Grid<float>& heights) {
  std::vector<Grid<float>> levels{heights};
  const auto has_gap = [](const Grid<float>& g) {
    return std::ranges::any_of(g.cells(), [](float h) { return std::isnan(h); });
  };
  while (has_gap(levels.back()) && (levels.back().columns() > 1 || levels.back().rows() > 1))
    levels.push_back(reduced(levels.back()));
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    Grid<float>& fine = levels[l];
    const Grid<float>& coarse = levels[l + 1];
    const Grid<float> upper =
        resample(coarse, {0, 0, 2, coarse.columns(), coarse.rows()}, {0, 0, 1, fine.columns(), fine.rows()});
    for (std::size_t i = 0; i < fine.cells().size(); ++i)
      if (std::isnan(fine.cells()[i])) fine.cells()[i] = upper.cells()[i];
  }
  return levels.front();
}

Grid<float> median_filter(const Grid<float>& heights) {
  Grid<float> out = heights;
  for (std::int64_t r = 0; r < heights.rows(); ++r)
    for (std::int64_t c = 0; c < heights.columns(); ++c) {
      if (std::isnan(heights(c, r))) continue;
      float near[9];
      std::ptrdiff_t count = 0;
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t i = -1; i <= 1; ++i)
          if (heights.contains(c + i, r + j) && !std::isnan(heights(c + i, r + j)))
            near[count++] = heights(c + i, r + j);
      std::nth_element(near, near + count / 2, near + count);
      out(c, r) = near[count / 2];
    }
  return out;
}

Terrain terrain_of(const Grid<float>& heights, const SurfaceGrid& grid) {
  return Terrain(heights, grid.x(0), grid.y(0), grid.cell, grid.cell);
}

}  // namespace waymark::pipeline
