// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Cells whose centres are (x0 + column dx, y0 + row dy); dx > 0, dy < 0.
struct CellFrame {
  double x0 = 0, y0 = 0, dx = 1, dy = -1;
  std::int64_t columns = 0, rows = 0;
};

/// Value of cells outside the convex hull.
enum class Beyond { nothing, nearest };

/// Interpolates heights at cell centres linearly in the Delaunay triangulation of points (x, y, z); NaN
/// outside it. Triangles with an edge longer than `longest_edge` are discarded. Of points at one position
/// the highest is used. The order of the points does not matter. About 1 us per point.
Grid<float> rasterised_tin(std::span<const Eigen::Vector3d> points, const CellFrame& frame,
                           double longest_edge, Beyond beyond);

}  // namespace waymark::pipeline
