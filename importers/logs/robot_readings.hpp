// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>
#include "localization/absolute_fix.hpp"
#include "localization/laser_scan.hpp"
namespace waymark::importers {

// Readings of a log from what messages of ROS state, be they of a recording or of a driving robot.

/// Covariance of three quantities, row-major. A first element of -1 says that they are not measured.
using Covariance3 = std::array<double, 9>;

/// Returns position and yaw of a pose as seen from above.
localization::Pose2 level_pose(const Eigen::Isometry3d& pose);

/// Returns a scan of a sensor in the middle of the robot; ranges below `min_range` are no return. Throws
/// std::runtime_error if it has no beams, or if angles or ranges cannot be. Intensities that are not one per
/// beam are left out.
localization::LaserScan laser_scan(double first_angle, double angle_step, float min_range, float max_range,
                                   std::vector<float> ranges, std::vector<float> intensities = {});

/// Returns whether the scans of a sensor are level, within 0.2 rad. It may hang upside down.
bool is_level(const Eigen::Isometry3d& robot_from_sensor);

/// Gives a scan the pose of its level sensor. Of one that hangs upside down the order of beams is turned.
void mount(localization::LaserScan& scan, const Eigen::Isometry3d& robot_from_sensor);

/// Returns the covariance, m2, of east and north of a satellite fix; `std::nullopt` if it is not stated.
/// `type` is position_covariance_type of NavSatFix. A direction without a variance gets that of the other.
/// Throws std::runtime_error.
std::optional<Eigen::Matrix2d> horizontal_covariance(const Covariance3& covariance, int type);

/// Returns a fix in degrees. Without a covariance its standard deviation is 3 m. The distance of the antenna
/// from the robot's middle, `arm`, m, is an error, since a heading to move the fix by is not certain.
localization::GnssFix fix_of_antenna(double longitude, double latitude,
                                     const std::optional<Eigen::Matrix2d>& covariance, double arm);

}  // namespace waymark::importers
