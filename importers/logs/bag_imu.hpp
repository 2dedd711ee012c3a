// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
#include "importers/logs/bag_messages.hpp"
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// Gives odometry that lacks a yaw (`lacks_yaw`) that of integrated turn rates, and the log the noise of the
/// gyro. Readings and poses are sorted by time. Adds a remark on what is used and what is not.
void add_turn_rates(localization::RobotLog& log, const std::string& topic,
                    const std::vector<BagImu>& readings, const Eigen::Matrix3d& body_from_imu,
                    std::vector<localization::StampedPose>& poses, bool lacks_yaw);

/// Adds the orientations that state a covariance as a compass, with a remark.
void add_headings(localization::RobotLog& log, const std::string& topic, const std::vector<BagImu>& readings,
                  const Eigen::Matrix3d& body_from_imu);

}  // namespace waymark::importers
