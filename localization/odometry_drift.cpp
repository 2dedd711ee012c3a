// SPDX-License-Identifier: Apache-2.0
#include "localization/odometry_drift.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark::localization {
namespace {

using Errors = DriftEstimator::Errors;
using PoseErrors = Eigen::Matrix<double, 3, 5>;
constexpr double kMaxJump = 25;  // squared Mahalanobis distance beyond which an update is a new start

Errors variances(const OdometryDrift& d) {
  return Errors(d.scale_sd, d.slip_sd, d.sideways_sd, d.yaw_rate_sd, d.curvature_sd).cwiseAbs2();
}

struct Update {
  Eigen::Vector3d moved;
  Eigen::Matrix3d inverse;  // of the covariance before
};

/// `std::nullopt` for a jump of the pose.
std::optional<Update> as_update(const PoseEstimate& before, const PoseEstimate& after) {
  const Eigen::Vector3d moved(after.pose.x - before.pose.x, after.pose.y - before.pose.y,
                              wrap_angle(after.pose.yaw - before.pose.yaw));
  const Eigen::Matrix3d inverse = (before.covariance + 1e-12 * Eigen::Matrix3d::Identity()).inverse();
  if (!inverse.allFinite() || !(moved.dot(inverse * moved) <= kMaxJump)) return {};
  return Update{moved, inverse};
}

}  // namespace

void OdometryDrift::describe(OptionVisitor& option) {
  option("scale_sd", scale_sd,
         {.help = "Standard deviation of the relative error of distances that lasts the drive",
          .min = 0,
          .max = 0.5});
  option("slip_sd", slip_sd,
         {.help = "Standard deviation of the relative error of distances that lasts drift_distance",
          .min = 0,
          .max = 0.5});
  option("sideways_sd", sideways_sd,
         {.help = "Standard deviation of metres sideways per metre driven, lasting drift_distance",
          .min = 0,
          .max = 0.5});
  option("drift_distance", drift_distance,
         {.help = "Metres driven until slip and sideways drift have fallen to 1/e", .min = 0.1, .max = 1e6});
  option("yaw_rate_sd", yaw_rate_sd,
         {.help = "Standard deviation of the bias of the turn rate, rad/s, that lasts the drive",
          .min = 0,
          .max = 0.5});
  option("curvature_sd", curvature_sd,
         {.help = "Standard deviation of yaw per metre driven, rad/m, that lasts the drive",
          .min = 0,
          .max = 0.5});
}

DriftEstimator::DriftEstimator(const OdometryDrift& prior)
    : prior_(prior), covariance_(variances(prior).asDiagonal()) {}

BodyMotion DriftEstimator::correct(const PoseEstimate& pose, const BodyMotion& motion, double seconds) {
  const Pose2& odometry = motion.step;
  BodyMotion corrected = motion;
  corrected.step.x += (mean_[0] + mean_[1]) * odometry.x - mean_[2] * odometry.y;
  corrected.step.y += (mean_[0] + mean_[1]) * odometry.y + mean_[2] * odometry.x;
  corrected.step.yaw = wrap_angle(odometry.yaw + mean_[3] * seconds + mean_[4] * odometry.x);
  PoseErrors by_errors = PoseErrors::Zero();  // of the step
  by_errors.col(0) << odometry.x, odometry.y, 0;
  by_errors.col(1) = by_errors.col(0);
  by_errors.col(2) << -odometry.y, odometry.x, 0;
  by_errors(2, 3) = seconds;
  by_errors(2, 4) = odometry.x;  // a robot that backs turns the other way

  const MotionJacobians j = motion_jacobians(pose.pose, corrected.step);
  const PoseErrors g = j.by_step * by_errors;
  const Eigen::Matrix3d cross = j.by_pose * with_pose_ * g.transpose();
  const Eigen::Matrix3d unknown = cross + cross.transpose() + g * covariance_ * g.transpose();
  corrected.covariance += j.by_step.transpose() * unknown * j.by_step;  // by_step is a rotation

  with_pose_ = j.by_pose * with_pose_ + g * covariance_;
  const double fade = std::exp(-odometry.at().norm() / prior_.drift_distance);
  const Errors fading(1, fade, fade, 1, 1);
  mean_ = mean_.cwiseProduct(fading);
  with_pose_ = with_pose_ * fading.asDiagonal();
  covariance_ = fading.asDiagonal() * covariance_ * fading.asDiagonal();
  const Errors all = variances(prior_);
  covariance_.diagonal() += all.cwiseProduct(Errors::Ones() - fading.cwiseAbs2());
  return corrected;
}

void DriftEstimator::learn(const PoseEstimate& before, const PoseEstimate& after) {
  const std::optional<Update> update = as_update(before, after);
  if (!update) return restart();
  const Eigen::Matrix<double, 5, 3> gain = with_pose_.transpose() * update->inverse;
  mean_ += gain * update->moved;
  covariance_ -= gain * (before.covariance - after.covariance) * gain.transpose();
  with_pose_ = after.covariance * update->inverse * with_pose_;
  covariance_ = (covariance_ + covariance_.transpose()).eval() / 2;
  // A mixture may widen, and samples have noise; the errors never become less certain than they were at
  // first. What exceeds that is scaled down with its correlations.
  const Errors all = variances(prior_);
  Errors scale = Errors::Ones();
  for (int i = 0; i < 5; ++i) {
    if (!(covariance_(i, i) >= 0)) return restart();
    if (covariance_(i, i) > all[i]) scale[i] = std::sqrt(all[i] / covariance_(i, i));
  }
  covariance_ = scale.asDiagonal() * covariance_ * scale.asDiagonal();
  with_pose_ = with_pose_ * scale.asDiagonal();
}

void DriftEstimator::consider(const PoseEstimate& before, const PoseEstimate& after) {
  const std::optional<Update> update = as_update(before, after);
  if (!update) return restart();
  with_pose_ = after.covariance * update->inverse * with_pose_;
}

void DriftEstimator::restart() {
  covariance_ = variances(prior_).asDiagonal();
  with_pose_.setZero();
}

}  // namespace waymark::localization
