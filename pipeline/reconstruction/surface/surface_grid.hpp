// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "core/grid.hpp"
#include "geo/terrain.hpp"
namespace waymark::pipeline {

/// Cells of a DEM in the grid frame, metres; (west, north) is the corner of the first cell.
struct SurfaceGrid {
  double west = 0, north = 0, cell = 1;
  std::int64_t columns = 0, rows = 0;

  double x(double column) const { return west + (column + 0.5) * cell; }
  double y(double row) const { return north - (row + 0.5) * cell; }
  double column(double at_x) const { return (at_x - west) / cell - 0.5; }
  double row(double at_y) const { return (north - at_y) / cell - 0.5; }
  /// Returns the grid of the same extent, or up to a cell more, with cells of another size.
  SurfaceGrid with_cell(double size) const;
};

/// Returns the heights bilinear at the cells of another grid; NaN where one of four is unknown. Beyond the
/// outermost centres the nearest ones count.
Grid<float> resample(const Grid<float>& heights, const SurfaceGrid& from, const SurfaceGrid& to);

/// Fills unknown cells from their surroundings by a pyramid of means, known ones unchanged. A grid without
/// heights stays so.
Grid<float> fill_gaps(const Grid<float>& heights);

/// Returns the median of the known cells of each 3 x 3; NaN stays NaN.
Grid<float> median_filter(const Grid<float>& heights);

/// Returns the terrain through the centres of the cells; needs 2 x 2 cells.
Terrain terrain_of(const Grid<float>& heights, const SurfaceGrid& grid);

}  // namespace waymark::pipeline
