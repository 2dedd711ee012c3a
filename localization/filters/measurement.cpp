// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/measurement.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <numbers>

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

ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const SeenLandmark& seen,
                        const MapLandmark& landmark) {
  if (!seen.extent || !landmark.is_line()) return expect(robot, robot_from_sensor, landmark.at);
  const Eigen::Vector2d sensor = (robot * robot_from_sensor).at(), lever = sensor - robot.at();
  const Eigen::Vector2d& n = landmark.normal;
  ExpectedSighting e;
  e.value << n.dot(sensor - landmark.at), 0;
  e.by_landmark << -n.x(), -n.y(), 0, 0;
  e.by_pose << n.x(), n.y(), n.dot(Eigen::Vector2d(-lever.y(), lever.x())), 0, 0, 0;
  return e;
}

bool may_overlap(const LineExtent& seen, const Eigen::Vector2d& sensor, const MapLandmark& line,
                 double slack) {
  const double middle = line.along().dot(line.at - sensor);
  return seen.from <= middle + line.half_length + slack && seen.to >= middle - line.half_length - slack;
}

double swing_variance(const MapLandmark& line, const Eigen::Vector2d& sensor) {
  const double middle = line.along().dot(line.at - sensor);
  return middle * middle * line.normal_variance;
}

Eigen::Vector2d innovation(const SeenLandmark& seen, const Eigen::Vector2d& expected) {
  return {seen.range ? *seen.range - expected[0] : 0,
          seen.bearing ? wrap_angle(*seen.bearing - expected[1]) : 0};
}

Eigen::Matrix2d sensor_noise(const SeenLandmark& seen) {
  return Eigen::Vector2d(seen.range ? seen.range_sd * seen.range_sd : 1,
                         seen.bearing ? seen.bearing_sd * seen.bearing_sd : 1)
      .asDiagonal();
}

SeenLandmark correct_curvature(const SeenLandmark& seen, const PoseEstimate& robot,
                               const Pose2& robot_from_sensor, const Eigen::Vector2d& landmark) {
  if (seen.bearing || seen.extent) return seen;
  const Eigen::Vector2d lever = (robot.pose * robot_from_sensor).at() - robot.pose.at();
  const Eigen::Vector2d to = landmark - robot.pose.at() - lever;
  const double range = to.norm();
  const Eigen::Vector2d across =
      range > 0 ? Eigen::Vector2d(-to.y() / range, to.x() / range) : Eigen::Vector2d(0, 1);
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << 1, 0, -lever.y(), 0, 1, lever.x();
  const Eigen::Vector3d h = by_pose.transpose() * across;
  const double variance = std::max(0.0, h.dot(robot.covariance * h));
  // Second derivative of the range across the line of sight: 1 / range. Nearer than the spread, the series
  // fails.
  const double curvature = variance > 0 ? variance / std::max(range, std::sqrt(variance)) : 0;
  SeenLandmark corrected = seen;
  *corrected.range -= curvature / 2;
  corrected.range_sd = std::hypot(seen.range_sd, curvature / std::numbers::sqrt2);
  return corrected;
}

double squared_distance(const SeenLandmark& seen, const Eigen::Vector2d& innovation,
                        const Eigen::Matrix2d& covariance) {
  if (seen.has_position()) return innovation.dot(covariance.inverse() * innovation);
  const int row = seen.range ? 0 : 1;
  return innovation[row] * innovation[row] / covariance(row, row);
}

}  // namespace waymark::localization
