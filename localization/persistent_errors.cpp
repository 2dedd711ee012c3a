// SPDX-License-Identifier: Apache-2.0
#include "localization/persistent_errors.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/covariance.hpp"
#include "localization/independent_fraction.hpp"

namespace waymark::localization {
namespace {

using Errors = PersistentErrors::Errors;
using PoseErrors = Eigen::Matrix<double, 3, PersistentErrors::kCount>;
constexpr int kShift = 5, kMount = 7, kMountYaw = 9;
constexpr double kMaxJump = 25;  // squared Mahalanobis distance beyond which an update is a new start

Errors variances(const OdometryDrift& d, const FrameErrors& f) {
  Errors sd;
  sd << d.scale_sd, d.slip_sd, d.sideways_sd, d.yaw_rate_sd, d.curvature_sd, f.map_shift_sd, f.map_shift_sd,
      f.mount_sd, f.mount_sd, f.mount_yaw_sd;
  return sd.cwiseAbs2();
}

Eigen::Matrix2d turn(double yaw) {
  return Eigen::Rotation2Dd(yaw).toRotationMatrix();
}

Eigen::Matrix3d inverse_of(const PoseEstimate& at) {
  return (at.covariance + 1e-12 * Eigen::Matrix3d::Identity()).inverse();
}

/// Returns `after`, but `before` in directions in which it is so much wider that samples do not explain it.
Eigen::Matrix3d without_widening(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after) {
  constexpr double noise = 1.5;  // of a variance
  const Eigen::Matrix3d root = square_root(before), identity = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d whiten = (root + 1e-9 * identity).inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> ratio(whiten * after * whiten.transpose());
  if (!(ratio.eigenvalues()[2] > noise)) return after;
  const Eigen::Array3d kept = (ratio.eigenvalues().array() > noise).select(1, ratio.eigenvalues().array());
  const Eigen::Matrix3d turned = root * ratio.eigenvectors();
  return turned * kept.matrix().asDiagonal() * turned.transpose();
}

struct Update {
  Eigen::Vector3d moved;
  Eigen::Matrix3d inverse;  // of the covariance before
};

/// `std::nullopt` for a jump of the pose.
std::optional<Update> as_update(const PoseEstimate& before, const PoseEstimate& after) {
  const Eigen::Vector3d moved(after.pose.x - before.pose.x, after.pose.y - before.pose.y,
                              wrap_angle(after.pose.yaw - before.pose.yaw));
  const Eigen::Matrix3d inverse = inverse_of(before);
  if (!inverse.allFinite() || !(moved.dot(inverse * moved) <= kMaxJump)) return {};
  return Update{moved, inverse};
}

}  // namespace

/// The robot's pose, its derivatives, and the covariance that knowing the localizer's pose would leave.
struct PersistentErrors::Robot {
  Pose2 pose;
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  PoseErrors by_errors = PoseErrors::Zero();
  Eigen::Matrix3d by_both = Eigen::Matrix3d::Identity();  // as the errors follow the pose
  Eigen::Matrix3d rest = Eigen::Matrix3d::Zero();
};

PersistentErrors::PersistentErrors(const OdometryDrift& drift, const FrameErrors& frames)
    : drift_(drift), frames_(frames) {
  frames_.map_shift_sd = frames.shift_is_learnt()
                             ? frames.survey_sd * std::sqrt(1 - IndependentFraction().mean())
                             : std::max(0.0, frames.map_shift_sd);
  covariance_ = variances(drift_, frames_).asDiagonal();
}

void PersistentErrors::scale_shift(double sd) {
  if (!(frames_.map_shift_sd > 0)) return;
  Errors scale = Errors::Ones();
  scale[kShift] = scale[kShift + 1] = sd / frames_.map_shift_sd;
  frames_.map_shift_sd = sd;
  mean_ = mean_.cwiseProduct(scale);
  with_pose_ = with_pose_ * scale.asDiagonal();
  covariance_ = scale.asDiagonal() * covariance_ * scale.asDiagonal();
}

BodyMotion PersistentErrors::correct(const PoseEstimate& pose, const BodyMotion& motion, double seconds) {
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

  const double driven = odometry.at().norm(), fade = std::exp(-driven / drift_.drift_distance),
               fade_shift = std::exp(-driven / frames_.map_shift_distance);
  if (frames_.any()) {
    // The sensors' step is that of the robot seen from their place on it, and what the shift loses.
    by_errors.middleCols<2>(kShift).topRows<2>() = (fade_shift - 1) * turn(-pose.pose.yaw);
    by_errors.middleCols<2>(kMount).topRows<2>() = turn(corrected.step.yaw) - Eigen::Matrix2d::Identity();
    by_errors.col(kMountYaw) << odometry.y, -odometry.x, 0;
    const Eigen::Vector3d by_frames = by_errors.rightCols<5>() * mean_.tail<5>();
    corrected.step.x += by_frames.x(), corrected.step.y += by_frames.y();
  }
  Errors fading = Errors::Ones();
  fading[1] = fading[2] = fade;
  fading[kShift] = fading[kShift + 1] = fade_shift;
  const Errors fresh = variances(drift_, frames_).cwiseProduct(Errors::Ones() - fading.cwiseAbs2());

  const MotionJacobians j = motion_jacobians(pose.pose, corrected.step);
  const PoseErrors g = j.by_step * by_errors;
  const Eigen::Matrix3d cross = j.by_pose * with_pose_ * g.transpose();
  Eigen::Matrix3d unknown = cross + cross.transpose() + g * covariance_ * g.transpose();
  unknown(0, 0) += fresh[kShift], unknown(1, 1) += fresh[kShift + 1];
  corrected.covariance += j.by_step.transpose() * unknown * j.by_step;  // by_step is a rotation

  with_pose_ = j.by_pose * with_pose_ + g * covariance_;
  mean_ = mean_.cwiseProduct(fading);
  with_pose_ = with_pose_ * fading.asDiagonal();
  with_pose_(0, kShift) += fresh[kShift], with_pose_(1, kShift + 1) += fresh[kShift + 1];
  covariance_ = fading.asDiagonal() * covariance_ * fading.asDiagonal();
  covariance_.diagonal() += fresh;
  return corrected;
}

void PersistentErrors::learn(const PoseEstimate& before, const PoseEstimate& after) {
  const std::optional<Update> update = as_update(before, after);
  if (!update) return restart();
  const Eigen::Matrix<double, kCount, 3> gain = with_pose_.transpose() * update->inverse;
  mean_ += gain * update->moved;
  covariance_ -= gain * (before.covariance - after.covariance) * gain.transpose();
  with_pose_ = after.covariance * update->inverse * with_pose_;
  limit();
}

// A mixture may widen, and samples have noise; the errors never become less certain than they were at first.
// Scales down what exceeds that, with its correlations.
void PersistentErrors::limit() {
  covariance_ = (covariance_ + covariance_.transpose()).eval() / 2;
  const Errors all = variances(drift_, frames_);
  Errors scale = Errors::Ones();
  for (int i = 0; i < kCount; ++i) {
    if (!(covariance_(i, i) >= 0)) return restart();
    if (covariance_(i, i) > all[i]) scale[i] = std::sqrt(all[i] / covariance_(i, i));
  }
  covariance_ = scale.asDiagonal() * covariance_ * scale.asDiagonal();
  with_pose_ = with_pose_ * scale.asDiagonal();
}

void PersistentErrors::consider(const PoseEstimate& before, const PoseEstimate& after) {
  const std::optional<Update> update = as_update(before, after);
  if (!update) return restart();
  // What a pose gets wider by, where a filter returns to an earlier estimate, has nothing to do with the
  // errors.
  with_pose_ = without_widening(before.covariance, after.covariance) * update->inverse * with_pose_;
}

// The localizer's pose is (robot + shift) * sensors.
PersistentErrors::Robot PersistentErrors::robot_by(const PoseEstimate& at) const {
  const Pose2 sensors{mean_[kMount], mean_[kMount + 1], mean_[kMountYaw]};
  Robot robot;
  robot.pose = at.pose * inverse(sensors);
  const Eigen::Matrix2d axes = turn(robot.pose.yaw);
  const Eigen::Vector2d offset = axes * sensors.at();
  robot.pose.x -= mean_[kShift], robot.pose.y -= mean_[kShift + 1];
  robot.by_pose.col(2) << offset.y(), -offset.x(), 1;
  robot.by_errors.middleCols<2>(kShift).topRows<2>() = -Eigen::Matrix2d::Identity();
  robot.by_errors.middleCols<2>(kMount).topRows<2>() = -axes;
  robot.by_errors.col(kMountYaw) << -offset.y(), offset.x(), -1;
  const Eigen::Matrix<double, kCount, 3> follow = with_pose_.transpose() * inverse_of(at);
  robot.by_both = robot.by_pose + robot.by_errors * follow;
  robot.rest =
      positive_part(robot.by_errors * (covariance_ - follow * with_pose_) * robot.by_errors.transpose());
  return robot;
}

PoseEstimate PersistentErrors::robot(const PoseEstimate& pose) const {
  if (!frames_.any()) return pose;
  const Robot robot = robot_by(pose);
  return {robot.pose, robot.by_both * pose.covariance * robot.by_both.transpose() + robot.rest};
}

std::optional<PoseEstimate> PersistentErrors::mount() const {
  if (!(frames_.mount_sd > 0 || frames_.mount_yaw_sd > 0)) return {};
  return PoseEstimate{pose_of(mean_.segment<3>(kMount)), covariance_.block<3, 3>(kMount, kMount)};
}

GnssFix PersistentErrors::relative_to_map(const GnssFix& fix, const PoseEstimate& pose) const {
  if (!frames_.any()) return fix;
  const Robot robot = robot_by(pose);
  const double separating = robot.rest.topLeftCorner<2, 2>().trace() / 2;
  GnssFix relative{fix.at + pose.pose.at() - robot.pose.at(), std::sqrt(fix.sd * fix.sd + separating)};
  if (fix.covariance) relative.covariance = *fix.covariance + separating * Eigen::Matrix2d::Identity();
  return relative;
}

HeadingFix PersistentErrors::relative_to_map(const HeadingFix& fix, const PoseEstimate& pose) const {
  if (!frames_.any()) return fix;
  const Robot robot = robot_by(pose);
  return {wrap_angle(fix.yaw + pose.pose.yaw - robot.pose.yaw),
          std::sqrt(fix.sd * fix.sd + robot.rest(2, 2))};
}

// Joseph form for the gain of the localizer by relative_to_map() and the Kalman gain of the errors.
template <int Rows>
void PersistentErrors::learn_fix(int first_row, const Eigen::Vector<double, Rows>& difference,
                                 const Eigen::Matrix<double, Rows, Rows>& noise, const PoseEstimate& before,
                                 const PoseEstimate& after) {
  constexpr int kAll = 3 + kCount;
  const std::optional<Update> update = as_update(before, after);
  if (!update) return restart();
  const Robot robot = robot_by(before);
  Eigen::Matrix<double, kAll, kAll> all;
  all << before.covariance, with_pose_, with_pose_.transpose(), covariance_;
  Eigen::Matrix<double, 3, kAll> by_all;
  by_all << robot.by_pose, robot.by_errors;
  const Eigen::Matrix<double, Rows, kAll> h = by_all.middleRows<Rows>(first_row);
  const Eigen::Matrix<double, Rows, Rows> s = h * all * h.transpose() + noise;
  Eigen::Matrix<double, kAll, Rows> gain = all * h.transpose() * s.inverse();
  const Eigen::Matrix<double, 3, Rows> robot_gain = by_all * gain;
  // Not of the covariances before and after: those of particles have noise larger than the gain of a poor
  // fix.
  const auto moved = before.covariance.middleCols<Rows>(first_row);
  const Eigen::Matrix<double, Rows, Rows> separating =
      robot.rest.block<Rows, Rows>(first_row, first_row).trace() / Rows *
      Eigen::Matrix<double, Rows, Rows>::Identity();
  gain.template topRows<3>() =
      moved * (moved.template middleRows<Rows>(first_row) + noise + separating).inverse();
  // The shift takes what the localizer's gain is too large or too small for the robot's position.
  if (frames_.map_shift_sd > 0)
    gain.template middleRows<2>(3 + kShift) += (by_all * gain - robot_gain).template topRows<2>();
  mean_ += gain.template bottomRows<kCount>() * difference;
  const Eigen::Matrix<double, kAll, kAll> keep = Eigen::Matrix<double, kAll, kAll>::Identity() - gain * h;
  all = (keep * all * keep.transpose() + gain * noise * gain.transpose()).eval();
  // The localizer took its part of the fix for independent, so its covariance is another one. The errors
  // follow the pose as computed, with the pose's covariance of the localizer.
  const Eigen::Matrix3d computed = all.template topLeftCorner<3, 3>();
  const PoseErrors follow =
      (computed + 1e-12 * Eigen::Matrix3d::Identity()).inverse() * all.template topRightCorner<3, kCount>();
  with_pose_ = after.covariance * follow;
  covariance_ = all.template bottomRightCorner<kCount, kCount>() +
                follow.transpose() * (after.covariance - computed) * follow;
  limit();
}

void PersistentErrors::learn(const GnssFix& fix, const PoseEstimate& before, const PoseEstimate& after) {
  if (!frames_.any()) return learn(before, after);
  learn_fix<2>(0, fix.at - robot(before).pose.at(), fix.noise(), before, after);
}

void PersistentErrors::learn(const HeadingFix& fix, const PoseEstimate& before, const PoseEstimate& after) {
  if (!frames_.any()) return learn(before, after);
  const Eigen::Vector<double, 1> difference(wrap_angle(fix.yaw - robot(before).pose.yaw));
  learn_fix<1>(2, difference, Eigen::Matrix<double, 1, 1>(fix.sd * fix.sd), before, after);
}

void PersistentErrors::restart() {
  covariance_ = variances(drift_, frames_).asDiagonal();
  with_pose_.setZero();
}

}  // namespace waymark::localization
