// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "pipeline/forest/stand_inventory.hpp"
namespace waymark {

/// A crown seen from above: an outline, or where none is known a circle.
struct StandCrown {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of the tree, metres
  double diameter = 0, diameter_sd = 0;             ///< metres; the outline's own where there is one
  std::vector<Eigen::Vector2d> ring = {};           ///< metres; empty: the circle about `place`
  double confidence = 1;
};

/// Share of the stand under crowns, 0 to 1. Crowns of trees outside that reach in count; where crowns overlap
/// the ground counts once. Measured on a lattice of places `step` metres apart that is fixed to the
/// coordinates, at most four million of them: wider apart in a stand that would need more.
///
/// The standard error adds, over the crowns, what the cover would lose without each (by its confidence), and
/// the error of its diameter on the ground that it covers alone. O(places + places under each crown).
Estimate cover(std::span<const StandCrown> crowns, const StandPolygon& stand, double step = 0.5);

}  // namespace waymark
