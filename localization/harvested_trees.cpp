// SPDX-License-Identifier: Apache-2.0
#include "localization/harvested_trees.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {

std::vector<HarvestedTree> harvested_trees(std::span<const FelledReading> felled, const Track& track) {
  std::vector<HarvestedTree> trees;
  for (const FelledReading& f : felled) {
    const auto after = std::ranges::upper_bound(track.rows, f.t, {}, &TrackRow::t);
    if (after == track.rows.begin()) continue;
    const PoseEstimate& machine = (after - 1)->at;
    const double angle = machine.pose.yaw + f.bearing, c = std::cos(angle), s = std::sin(angle);
    HarvestedTree tree{.t = f.t, .at = machine.pose.at() + f.range * Eigen::Vector2d(c, s)};
    Eigen::Matrix<double, 2, 3> by_pose;
    by_pose << 1, 0, -f.range * s, 0, 1, f.range * c;
    Eigen::Matrix2d by_crane;  // range, bearing
    by_crane << c, -f.range * s, s, f.range * c;
    const Eigen::Vector2d crane(f.range_sd * f.range_sd, f.bearing_sd * f.bearing_sd);
    tree.covariance = by_pose * machine.covariance * by_pose.transpose() +
                      by_crane * crane.asDiagonal() * by_crane.transpose();
    tree.diameter = f.diameter;
    tree.height = f.height;
    trees.push_back(tree);
  }
  return trees;
}

}  // namespace waymark::localization
