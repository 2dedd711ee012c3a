// SPDX-License-Identifier: Apache-2.0
#include "planning/odometry_belief.hpp"

#include <Eigen/LU>
#include <cmath>

namespace waymark::planning {
namespace {

double square(double value) {
  return value * value;
}

/// At a constant speed a bias of the curvature is one of the turn rate.
double yaw_rate_variance(const Odometry& o) {
  return square(o.drift.yaw_rate_sd) + square(o.drift.curvature_sd * o.speed);
}

Eigen::Vector4d variances(const Odometry& o) {
  return {square(o.drift.scale_sd), square(o.drift.slip_sd), square(o.drift.sideways_sd),
          yaw_rate_variance(o)};
}

}  // namespace

localization::OdometryNoise Odometry::white() const {
  localization::OdometryNoise all = noise;
  const double twice = 2 * drift.drift_distance;
  all.along_per_metre += twice * (square(drift.scale_sd) + square(drift.slip_sd));
  all.across_per_metre += twice * square(drift.sideways_sd);
  all.yaw_per_metre += twice * yaw_rate_variance(*this) / square(speed);
  return all;
}

DriveBelief::DriveBelief(const Symmetric3& start, const Odometry& odometry) : odometry_(odometry) {
  covariance_.topLeftCorner<3, 3>() = start.matrix();
  covariance_.bottomRightCorner<4, 4>() = variances(odometry).asDiagonal();
}

void DriveBelief::drive(const DriveStep& step) {
  const double c = step.east, s = step.north, length = step.length;
  Matrix7 f = Matrix7::Identity();
  f(0, 2) = -length * s, f(1, 2) = length * c;
  f(0, 3) = f(0, 4) = length * c, f(1, 3) = f(1, 4) = length * s;
  f(0, 5) = -length * s, f(1, 5) = length * c;
  // A bias of the turn rate turns the step by half of what it adds to the yaw.
  const double seconds = length / odometry_.speed;
  f(0, 6) = -length * s * seconds / 2, f(1, 6) = length * c * seconds / 2, f(2, 6) = seconds;
  const double fade = std::exp(-length / odometry_.drift.drift_distance);
  f(4, 4) = f(5, 5) = fade;
  covariance_ = (f * covariance_ * f.transpose()).eval();
  covariance_.topLeftCorner<3, 3>() += predict({}, step, odometry_.noise).matrix();
  const Eigen::Vector4d prior = variances(odometry_);
  covariance_(4, 4) += prior[1] * (1 - fade * fade);
  covariance_(5, 5) += prior[2] * (1 - fade * fade);
}

void DriveBelief::see(const Symmetric3& information) {
  // P - P' J (I + P J)^-1 P: no inverse of P, whose errors may be known exactly.
  const Eigen::Matrix3d j = information.matrix();
  const Eigen::Matrix<double, 7, 3> by_pose = covariance_.leftCols<3>();
  const Eigen::Matrix3d kept =
      (Eigen::Matrix3d::Identity() + by_pose.topRows<3>() * j).inverse();  // of the pose's covariance
  covariance_ -= (by_pose * j * kept * by_pose.transpose()).eval();
  covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();
}

}  // namespace waymark::planning
