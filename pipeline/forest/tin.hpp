// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include "core/grid.hpp"
namespace waymark {

/// Cells whose centres are (x0 + column dx, y0 + row dy); dx > 0, dy < 0.
struct CellFrame {
  double x0 = 0, y0 = 0, dx = 1, dy = -1;
  std::int64_t columns = 0, rows = 0;
};

/// What cells beyond the outermost points get.
enum class Beyond { nothing, nearest };

/// Heights at the cells' centres from the Delaunay triangulation of points (x, y, z), linear in each
/// triangle; NaN where there is none. Triangles with an edge longer than `longest_edge` are left out. Of
/// points at one place the highest counts. The same points in any order give the same heights. About 1 us per
/// point.
Grid<float> rasterised_tin(std::span<const Eigen::Vector3d> points, const CellFrame& frame,
                           double longest_edge, Beyond beyond);

}  // namespace waymark
