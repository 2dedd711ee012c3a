// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <numbers>
namespace waymark::localization {

/// Wraps an angle to [-pi, pi].
inline double wrap_angle(double angle) {
  return std::abs(angle) <= std::numbers::pi ? angle : std::remainder(angle, 2 * std::numbers::pi);
}

/// Position and heading in the plane: metres, and radians from x (east, forward) towards y (north, left).
struct Pose2 {
  double x = 0, y = 0, yaw = 0;

  Eigen::Vector2d at() const { return {x, y}; }
  Eigen::Vector3d vector() const { return {x, y, yaw}; }
  bool finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(yaw); }
  friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// Returns the pose of a vector x, y, yaw; wraps the yaw.
inline Pose2 pose_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), wrap_angle(v.z())};
}

/// Returns a_from_c of a_from_b and b_from_c.
inline Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const double c = std::cos(a_from_b.yaw), s = std::sin(a_from_b.yaw);
  return {a_from_b.x + c * b_from_c.x - s * b_from_c.y, a_from_b.y + s * b_from_c.x + c * b_from_c.y,
          wrap_angle(a_from_b.yaw + b_from_c.yaw)};
}

/// Returns b_from_a.
inline Pose2 inverse(const Pose2& a_from_b) {
  const double c = std::cos(a_from_b.yaw), s = std::sin(a_from_b.yaw);
  return {-c * a_from_b.x - s * a_from_b.y, s * a_from_b.x - c * a_from_b.y, -a_from_b.yaw};
}

/// A pose and its covariance, in the order x, y, yaw: m^2, m rad, rad^2.
struct PoseEstimate {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

}  // namespace waymark::localization
