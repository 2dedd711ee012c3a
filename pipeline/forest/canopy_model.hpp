// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Cells whose centres are (x0 + column dx, y0 + row dy); dx > 0, dy < 0.
struct CellFrame {
  double x0 = 0, y0 = 0, dx = 1, dy = -1;
  std::int64_t columns = 0, rows = 0;
};

/// Laser points in and around a block of a canopy model; x, y, z in metres.
struct LaserPoints {
  std::vector<Eigen::Vector3d> ground;   ///< classified as ground
  std::vector<Eigen::Vector3d> surface;  ///< first returns, including ground; without noise
};

struct CanopyBlock {
  Grid<float> heights;  ///< above ground, metres; NaN: no data
  Grid<float> ground;   ///< elevation, metres
};

/// Returns elevations of the ground at cell centres, metres: linear in the Delaunay triangulation of ground
/// points, beyond it that of the nearest. NaN without points. The order of the points does not matter.
Grid<float> ground_grid(std::span<const Eigen::Vector3d> ground, const CellFrame& frame);

/// Computes a pit-free canopy height model (Khosravipour et al. 2014).
/// - Heights above the ground TIN are triangulated from the highest point of each cell. The same follows with
///   short edges for points above 2, 5, 10, 15 ... metres; each cell takes the highest layer.
/// - `spacing`: mean distance of first returns, metres.
/// - Points around the frame are needed for correct edges.
/// Departure: heights of points are above the ground TIN sampled at the cells, interpolated.
CanopyBlock canopy_block(const LaserPoints& points, const CellFrame& frame, double spacing);

/// Cells of a terrain model that canopy_block() needs on each side of the frame.
inline constexpr std::int64_t kTerrainMargin = 16;

/// Computes the same over a terrain model in place of ground points; `surface` as in LaserPoints.
/// - `terrain`: elevations in metres on the cells of the frame and kTerrainMargin more on each side; NaN if
///   unknown.
/// - Heights over unknown terrain are NaN.
CanopyBlock canopy_block(std::span<const Eigen::Vector3d> surface, const Grid<float>& terrain,
                         const CellFrame& frame, double spacing);

}  // namespace waymark::pipeline
