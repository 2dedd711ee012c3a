// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// Returns position and yaw of a pose as seen from above.
inline localization::Pose2 level_pose(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(), std::atan2(pose(1, 0), pose(0, 0))};
}

}  // namespace waymark::importers
