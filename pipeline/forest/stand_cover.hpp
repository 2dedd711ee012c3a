// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "pipeline/forest/stand_inventory.hpp"
namespace waymark::pipeline {

/// Projected crown: an outline, or a circle if there is none.
struct StandCrown {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the stem, metres
  double diameter = 0, diameter_sd = 0;                ///< metres; of the outline if there is one
  std::vector<Eigen::Vector2d> ring = {};              ///< metres; empty: the circle about `position`
  double confidence = 1;
};

/// Returns the canopy cover of the stand, 0 to 1, with its standard error. O(points + points under each
/// crown).
/// - Crowns of trees outside count where they reach in; overlapping crowns count once.
/// - Sampled on a lattice of points `step` metres apart, fixed to the coordinates; at most four million
///   points, so wider in large stands.
/// - The standard error sums over crowns the cover lost without each (by its confidence) and the error of
///   its diameter on the area that it alone covers.
Estimate canopy_cover(std::span<const StandCrown> crowns, const StandPolygon& stand, double step = 0.5);

}  // namespace waymark::pipeline
