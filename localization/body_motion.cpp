// SPDX-License-Identifier: Apache-2.0
#include "localization/body_motion.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/covariance.hpp"

namespace waymark::localization {

MotionJacobians motion_jacobians(const Pose2& pose, const Pose2& step) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  MotionJacobians j;
  j.by_pose << 1, 0, -s * step.x - c * step.y,  //
      0, 1, c * step.x - s * step.y,            //
      0, 0, 1;
  j.by_step << c, -s, 0,  //
      s, c, 0,            //
      0, 0, 1;
  return j;
}

namespace {

constexpr double kMinKept = 0.8;  // of the variance of a pose in one motion

PoseEstimate predict_linearly(const PoseEstimate& estimate, const BodyMotion& motion) {
  const MotionJacobians j = motion_jacobians(estimate.pose, motion.step);
  const Eigen::Matrix3d p = j.by_pose * estimate.covariance * j.by_pose.transpose() +
                            j.by_step * motion.covariance * j.by_step.transpose();
  return {estimate.pose * motion.step, (p + p.transpose()) / 2};
}

}  // namespace

PoseEstimate predict_pose(const PoseEstimate& estimate, const BodyMotion& motion) {
  const PoseEstimate after = predict_linearly(estimate, motion);
  if (is_covariance(motion.covariance)) return after;
  // One motion undoes little of an error. More is undone of another pose's error, which was larger.
  const Eigen::Matrix3d before =
      predict_linearly(estimate, {motion.step, Eigen::Matrix3d::Zero()}).covariance;
  if (is_covariance(Eigen::Matrix3d(after.covariance - kMinKept * before))) return after;
  return predict_other_pose(estimate, motion);
}

PoseEstimate predict_other_pose(const PoseEstimate& estimate, const BodyMotion& motion) {
  return predict_linearly(estimate, {motion.step, positive_part(motion.covariance)});
}

BodyMotion compose(const BodyMotion& first, const BodyMotion& second) {
  const PoseEstimate both = predict_linearly({first.step, first.covariance}, second);
  return {both.pose, both.covariance};
}

MotionCompensation::MotionCompensation(const BodyMotion& motion)
    : motion_(motion), back_(Eigen::Rotation2Dd(-motion.step.yaw).toRotationMatrix()) {}

void MotionCompensation::apply(Eigen::Vector2d& at, Eigen::Matrix2d& covariance) const {
  at = back_ * (at - motion_.step.at());
  Eigen::Matrix<double, 2, 3> by_step;
  by_step << -back_, Eigen::Vector2d(at.y(), -at.x());
  covariance = back_ * covariance * back_.transpose() + by_step * motion_.covariance * by_step.transpose();
}

Eigen::Matrix3d square_root(const Eigen::Matrix3d& symmetric) {
  const Eigen::Matrix3d covariance = positive_part(symmetric);
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    double left = covariance(j, j) - root.row(j).head(j).squaredNorm();
    if (!(left > 1e-14 * covariance(j, j))) continue;  // no variance in this direction
    root(j, j) = std::sqrt(left);
    for (int i = j + 1; i < 3; ++i)
      root(i, j) = (covariance(i, j) - root.row(i).head(j).dot(root.row(j).head(j))) / root(j, j);
  }
  return root;
}

}  // namespace waymark::localization
