// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// Turn rate of a robot about its vertical axis.
struct TurnRate {
  double t = 0;         ///< s
  double rate = 0;      ///< rad/s to the left
  double variance = 0;  ///< (rad/s)^2, of independent errors; 0: not stated
};

/// Returns the poses of odometry that measures no yaw, with the yaw of integrated turn rates (trapezoids).
/// The steps between poses keep their length; they are chords of arcs, turned by half of the yaw of the step.
/// Before the first and after the last rate the robot does not turn. Both are sorted by time.
std::vector<localization::StampedPose> with_yaw_of_gyro(std::vector<localization::StampedPose> poses,
                                                        std::span<const TurnRate> rates);

/// Returns the variance of the integrated yaw per second, rad^2/s: mean variance of the rates times their
/// mean distance in time; 0 if they state none.
double yaw_variance_per_second(std::span<const TurnRate> rates);

/// Gives a log the odometry noise of a robot whose yaw is that of a small gyro: its variance per second,
/// rad^2/s, a scale error of 1 % and a bias of 0.005 rad/s that is estimated with the pose.
void use_gyro_noise(localization::RobotLog& log, double variance_per_second);

}  // namespace waymark::importers
