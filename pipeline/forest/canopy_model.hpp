// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/forest/tin.hpp"
namespace waymark {

/// Laser points about a block of a canopy model, x, y, z in metres.
struct LaserPoints {
  std::vector<Eigen::Vector3d> ground;   ///< classified as ground
  std::vector<Eigen::Vector3d> surface;  ///< first returns, ground included; no noise
};

struct CanopyBlock {
  Grid<float> heights;  ///< above ground, metres; NaN where nothing is known
  Grid<float> ground;   ///< elevation, metres
};

/// A pit-free canopy model (Khosravipour et al. 2014): the points' heights above the TIN of the ground, the
/// highest of each cell, triangulated again and again from those above 0, 2, 5, 10, 15 ... metres with short
/// edges only, the highest of all at each cell. `spacing`: mean distance of first returns, metres. Points
/// around the frame make its edges right.
/// Departure: heights of points are taken above the ground TIN sampled at the cells, interpolated.
CanopyBlock canopy_block(const LaserPoints& points, const CellFrame& frame, double spacing);

}  // namespace waymark
