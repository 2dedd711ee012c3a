// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark {

/// A felled tree on the map.
struct HarvestedTree {
  double t = 0;                                          ///< s, when it was felled
  Eigen::Vector2d at = Eigen::Vector2d::Zero();          ///< m, map frame
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the machine's pose and the crane, m^2
  double diameter = 0, height = 0;                       ///< m; 0: not measured
};

/// Puts what the crane felled where the track says the machine stood: the last row not after each tree, so it
/// can be called while the machine works. Trees before the first row are left out. O(trees log rows).
std::vector<HarvestedTree> harvested_trees(std::span<const FelledReading> felled, const Track& track);

}  // namespace waymark
