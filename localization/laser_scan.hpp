// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/pose2.hpp"
namespace waymark {

/// One sweep of a line scanner. Beam i points at first_angle + i angle_step, radians from the sensor's x axis
/// (forward) to the left.
struct LaserScan {
  Pose2 robot_from_sensor;
  double first_angle = 0, angle_step = 0;
  std::vector<float> ranges;  ///< m; not finite, <= 0 or >= most_range: nothing was hit
  double most_range = 80;     ///< m
};

}  // namespace waymark
