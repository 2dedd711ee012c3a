// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/pose2.hpp"
namespace waymark {

/// How the robot moved, seen from where it stood: new_from_old of its frame, with covariance (x forward, y
/// left, yaw). Every motion model ends in one of these, and every filter begins with one.
struct BodyMotion {
  Pose2 step;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Derivatives of pose * step by the pose and by the step.
struct MotionJacobians {
  Eigen::Matrix3d by_pose, by_step;
};
MotionJacobians motion_jacobians(const Pose2& pose, const Pose2& step);

/// First one, then the other, to first order in the errors, which are taken as independent.
BodyMotion then(const BodyMotion& first, const BodyMotion& second);

/// What was seen from the old place, as it is seen from the new one.
class SeenAfter {
 public:
  /// `motion` must outlive it.
  explicit SeenAfter(const BodyMotion& motion);
  /// A point in the robot's frame and its covariance, which grows by that of the motion.
  void move(Eigen::Vector2d& at, Eigen::Matrix2d& covariance) const;

 private:
  const BodyMotion& motion_;
  Eigen::Matrix2d back_;
};

/// Prediction step of an extended Kalman filter.
PoseEstimate moved(const PoseEstimate& estimate, const BodyMotion& motion);

/// Lower triangular L with L L' = covariance + tiny; zero rows where there is no noise. For covariances that
/// are only positive semidefinite, as those of a robot that cannot slip sideways.
Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance);

}  // namespace waymark
