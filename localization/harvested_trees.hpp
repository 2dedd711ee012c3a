// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::localization {

/// A felled tree on the map.
struct HarvestedTree {
  double t = 0;                                          ///< s, when it was felled
  Eigen::Vector2d at = Eigen::Vector2d::Zero();          ///< m, map frame
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2, from the machine's pose and the crane
  double diameter = 0, height = 0;                       ///< m; 0: not measured
};

/// Returns the map positions of the trees that the crane felled, from the last row of the track not after
/// each tree. Can be called while the machine works. Omits trees before the first row. O(trees log rows).
std::vector<HarvestedTree> harvested_trees(std::span<const FelledReading> felled, const Track& track);

}  // namespace waymark::localization
