// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/motion_model.hpp"
namespace waymark::planning {

/// Symmetric 3 x 3 matrix of x, y, yaw: a covariance (m^2, m rad, rad^2) or an information matrix.
struct Symmetric3 {
  double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;

  Eigen::Matrix3d matrix() const;
  friend bool operator==(const Symmetric3&, const Symmetric3&) = default;
};

/// Adds `factor` times a matrix to a sum.
void add(Symmetric3& sum, const Symmetric3& more, double factor);

/// Returns the upper triangle of a symmetric matrix.
Symmetric3 symmetric(const Eigen::Matrix3d& matrix);

/// Drive of `length` metres straight along a unit direction, after a turn on the spot, radians.
struct DriveStep {
  double length = 0, east = 1, north = 0, turn = 0;
};

/// Returns the covariance after a drive with the odometry noise of the localizers. Exact for noise that is
/// continuous along the path: two half steps equal one whole step.
Symmetric3 predict(const Symmetric3& covariance, const DriveStep& step,
                   const localization::OdometryNoise& noise);

/// Returns (P^-1 + J)^-1 for a positive definite covariance P and information J >= 0.
Symmetric3 update(const Symmetric3& covariance, const Symmetric3& information);

/// Returns the standard deviation of the position in its worst direction, metres.
double position_sd(const Symmetric3& covariance);

/// Returns whether `scale` a - b is positive definite: b is the smaller covariance.
bool exceeds(const Symmetric3& a, const Symmetric3& b, double scale = 1);

}  // namespace waymark::planning
