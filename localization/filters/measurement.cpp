// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/measurement.hpp"

#include <algorithm>

namespace waymark::localization {

ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const Eigen::Vector2d& landmark) {
  const double c = std::cos(robot.yaw), s = std::sin(robot.yaw);
  const Eigen::Vector2d lever(c * robot_from_sensor.x - s * robot_from_sensor.y,
                              s * robot_from_sensor.x + c * robot_from_sensor.y);
  const Eigen::Vector2d to = landmark - robot.at() - lever;
  const double range = std::max(to.norm(), 1e-3), square = range * range;
  ExpectedSighting e;
  e.value << range, wrap_angle(std::atan2(to.y(), to.x()) - robot.yaw - robot_from_sensor.yaw);
  e.by_landmark << to.x() / range, to.y() / range, -to.y() / square, to.x() / square;
  e.by_pose.leftCols<2>() = -e.by_landmark;
  // Turning the robot moves the sensor about it and turns the sensor itself.
  e.by_pose.col(2) = e.by_landmark * Eigen::Vector2d(lever.y(), -lever.x()) - Eigen::Vector2d(0, 1);
  return e;
}

Eigen::Vector2d innovation(const SeenLandmark& seen, const Eigen::Vector2d& expected) {
  return {seen.range ? *seen.range - expected[0] : 0, wrap_angle(seen.bearing - expected[1])};
}

Eigen::Matrix2d sensor_noise(const SeenLandmark& seen) {
  return Eigen::Vector2d(seen.range ? seen.range_sd * seen.range_sd : 1, seen.bearing_sd * seen.bearing_sd)
      .asDiagonal();
}

}  // namespace waymark::localization
