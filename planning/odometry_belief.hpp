// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/odometry_drift.hpp"
#include "planning/belief.hpp"
namespace waymark::planning {

/// Odometry as a log states it: the errors that the localizers reckon with.
struct Odometry {
  localization::OdometryNoise noise = {};
  localization::OdometryDrift drift = {};
  double speed = 0.5;  ///< m/s, turns rates into errors per metre

  /// Returns noise of independent errors that stands for all of them: what a search can afford. An error that
  /// persists counts as white noise of equal spectral density, 2 x drift_distance x variance.
  localization::OdometryNoise white() const;
};

/// Covariance of the pose and of the persistent odometry errors, which landmarks teach: the Gaussian of
/// localization::PersistentErrors.
class DriveBelief {
 public:
  DriveBelief(const Symmetric3& start, const Odometry& odometry);

  void drive(const DriveStep& step);
  /// Adds information of the pose.
  void see(const Symmetric3& information);
  Symmetric3 pose() const { return symmetric(covariance_.topLeftCorner<3, 3>()); }

 private:
  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  Odometry odometry_;
  Matrix7 covariance_ = Matrix7::Zero();  // x, y, yaw, scale, slip, sideways, yaw rate
};

}  // namespace waymark::planning
