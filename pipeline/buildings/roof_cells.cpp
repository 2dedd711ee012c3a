// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/roof_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::pipeline {
namespace {

constexpr double kSide = 0.5;  // m
// Metres, and times the side of a cell: a roof of 60 degrees falls by less within a cell.
constexpr double kBelowTop = 0.5, kBelowTopPerSide = 2;

// Of a cell; more are a damaged file, and sums of them would overflow.
constexpr std::int32_t kMaxReturns = 1'000'000;

void add(CellSums& sums, double dx, double dy, double dz) {
  if (sums.count >= kMaxReturns) return;
  const auto x = std::llround(dx * 1000), y = std::llround(dy * 1000), z = std::llround(dz * 1000);
  ++sums.count;
  sums.x += static_cast<std::int32_t>(x), sums.y += static_cast<std::int32_t>(y), sums.z += z;
  sums.xx += x * x, sums.xy += x * y, sums.yy += y * y;
  sums.xz += x * z, sums.yz += y * z, sums.zz += z * z;
}

}  // namespace

std::array<std::int64_t, 2> RoofCells::cell_of(double x, double y) const {
  const auto index = [&](double at) {
    return static_cast<std::int64_t>(std::floor((std::floor(at + 0.5) + 0.5) / static_cast<double>(step)));
  };
  return {index(x / cell_x) - window.column, index(-y / cell_y) - window.row};
}

std::int64_t roof_cell_step(const GridGeometry& grid) {
  const double cell = grid.where.dx * grid.where.crs.metres_per_unit();
  return std::max<std::int64_t>(1, std::llround(kSide / cell));
}

RoofCells sum_roof_cells(const CanopySource& canopy, const Window& window, double min_height) {
  const Georeference& where = canopy.geometry().where;
  const double unit = where.crs.metres_per_unit();
  const std::int64_t step = roof_cell_step(canopy.geometry());
  RoofCells all{.step = step,
                .window = window,
                .width = where.dx * unit * static_cast<double>(step),
                .height = -where.dy * unit * static_cast<double>(step),
                .cell_x = where.dx * unit,
                .cell_y = -where.dy * unit,
                .cells = Grid<RoofCell>(window.columns, window.rows),
                .density = canopy.point_density()};
  const Window fine{window.column * step, window.row * step, window.columns * step, window.rows * step};
  const auto is_roof = [&](const SurfacePoint& p) {
    return p.is_last() && !p.is_plant() && static_cast<double>(p.height) >= min_height;
  };
  Grid<double> top(window.columns, window.rows, -std::numeric_limits<double>::infinity());
  canopy.visit_surface(fine, [&](const SurfacePoint& p) {
    const auto [c, r] = all.cell_of(p.x, p.y);
    if (top.contains(c, r) && is_roof(p)) top(c, r) = std::max(top(c, r), p.z);
  });
  const double below = kBelowTop + kBelowTopPerSide * std::max(all.width, all.height);
  canopy.visit_surface(fine, [&](const SurfacePoint& p) {
    const auto [c, r] = all.cell_of(p.x, p.y);
    if (!all.cells.contains(c, r)) return;
    RoofCell& cell = all.cells(c, r);
    const bool high = static_cast<double>(p.height) >= min_height;
    if (high && p.is_first() && p.of > 0) {
      ++cell.pulses;
      cell.split += p.of > 1;
    }
    if (!p.is_last()) return;
    if (!high) {
      ++cell.low;
    } else if (p.is_plant()) {
      ++cell.plant;
    } else if (p.z >= top(c, r) - below) {
      const Eigen::Vector2d centre = all.centre(c, r);
      add(cell.high, p.x - centre.x(), p.y - centre.y(), p.z);
      cell.classed += p.classification == 6;
    }
  });
  return all;
}

}  // namespace waymark::pipeline
