// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// Adds the steps between poses by odometry, in the order of their times, and sorts the events by time. Steps
/// come before the other events of their time, which they lead to.
void add_odometry_steps(localization::RobotLog& log, std::vector<localization::StampedPose> poses);

}  // namespace waymark::importers
