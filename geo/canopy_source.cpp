// SPDX-License-Identifier: Apache-2.0
#include "geo/canopy_source.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace waymark::inline geo {

Grid<float> CanopySource::ground(const Window& window) const {
  const GridGeometry& grid = geometry();
  Grid<float> ground(window.columns, window.rows, std::nanf(""));
  for (std::int64_t r = std::max<std::int64_t>(0, window.row); r < std::min(window.end_row(), grid.rows); ++r)
    for (std::int64_t c = std::max<std::int64_t>(0, window.column);
         c < std::min(window.end_column(), grid.columns); ++c)
      ground(c - window.column, r - window.row) = static_cast<float>(ground_elevation(c, r));
  return ground;
}

void CanopySource::visit_surface(const Window& window,
                                 const std::function<void(const SurfacePoint&)>& use) const {
  const Georeference& where = geometry().where;
  const double unit = where.crs.metres_per_unit();
  const Grid<float> heights = read(window), below = ground(window);
  for (std::int64_t r = 0; r < window.rows; ++r)
    for (std::int64_t c = 0; c < window.columns; ++c) {
      if (heights(c, r) == kNoCanopy) continue;
      const double zero = std::isnan(below(c, r)) ? 0 : static_cast<double>(below(c, r));
      use({.x = static_cast<double>(window.column + c) * where.dx * unit,
           .y = static_cast<double>(window.row + r) * where.dy * unit,
           .z = zero + static_cast<double>(heights(c, r)),
           .height = heights(c, r)});
    }
}

GridGeometry common_grid(const Canopies& canopies) {
  if (canopies.empty()) throw std::logic_error("common_grid: no canopy");
  GridGeometry common = canopies[0]->geometry();
  const Georeference first = common.where;
  double left = 0, upper = 0;
  auto right = static_cast<double>(common.columns - 1), lower = static_cast<double>(common.rows - 1);
  for (const auto& canopy : canopies) {
    const GridGeometry& grid = canopy->geometry();
    left = std::min(left, first.column(grid.where.x(0)));
    upper = std::min(upper, first.row(grid.where.y(0)));
    right = std::max(right, first.column(grid.where.x(static_cast<double>(grid.columns - 1))));
    lower = std::max(lower, first.row(grid.where.y(static_cast<double>(grid.rows - 1))));
  }
  left = std::floor(left + 1e-3), upper = std::floor(upper + 1e-3);
  common.where.x0 = first.x(left), common.where.y0 = first.y(upper);
  common.columns = static_cast<std::int64_t>(std::ceil(right - left - 1e-3)) + 1;
  common.rows = static_cast<std::int64_t>(std::ceil(lower - upper - 1e-3)) + 1;
  return common;
}

Window tile_window(const GridGeometry& grid, const GridGeometry& common, const Window& tile) {
  const auto column = [&](std::int64_t edge) {  // the first column whose centre lies right of the tile's edge
    const double at = grid.where.column(common.where.x(static_cast<double>(edge) - 0.5));
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(at - 1e-6)), 0, grid.columns);
  };
  const auto row = [&](std::int64_t edge) {
    const double at = grid.where.row(common.where.y(static_cast<double>(edge) - 0.5));
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(at - 1e-6)), 0, grid.rows);
  };
  Window part{column(tile.column), row(tile.row), 0, 0};
  part.columns = column(tile.end_column()) - part.column;
  part.rows = row(tile.end_row()) - part.row;
  return part;
}

}  // namespace waymark::inline geo
