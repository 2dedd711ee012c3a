// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
namespace waymark::pipeline {

/// Parameters of the ground filter. Metres and radians.
struct GroundRules {
  double square = 20;   ///< side of the squares whose lowest returns are seeds: wider than crowns and houses
  double cell = 0.5;    ///< only the lowest return of a cell of this side may be ground
  double distance = 1;  ///< maximum distance of a return from the plane of its triangle
  double angle = 0.16;  ///< maximum angle between that plane and the lines to the triangle's corners
  double max_seed_slope = 0.6;  ///< maximum median slope of a seed above its neighbours
  double max_depth_below = 3;   ///< returns farther below all others within four metres are errors
};

/// Classifies ground returns by progressive TIN densification (Axelsson 2000). About 5 us per cell.
/// - Seeds are the lowest return of each square. Returns near the plane of their triangle, at small angles
///   to its corners, are added until none qualifies.
/// - Squares and cells lie at whole multiples of their sides, so neighbouring blocks of a survey agree but
///   for a margin of about two squares.
/// - The order of the returns does not matter. Empty for fewer than four squares with returns.
/// Departures: only the lowest return of each cell is tested. Steep edges are not mirrored, so terraces and
/// cliffs above `distance` are rounded.
std::vector<Eigen::Vector3d> ground_returns(std::span<const Eigen::Vector3d> returns,
                                            const GroundRules& rules = {});

}  // namespace waymark::pipeline
