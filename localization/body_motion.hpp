// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Motion of the robot, new_from_old of its frame, with covariance (x forward, y left, yaw). Every motion
/// model returns one, and every filter predicts with one. Of an error that persists (PersistentErrors) the
/// covariance may have a negative part: what the motion undoes of the pose's own.
struct BodyMotion {
  Pose2 step;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Derivatives of pose * step with respect to the pose and to the step.
struct MotionJacobians {
  Eigen::Matrix3d by_pose, by_step;
};
/// Computes the derivatives at a pose and a step.
MotionJacobians motion_jacobians(const Pose2& pose, const Pose2& step);

/// Composes two motions, `first` before `second`, to first order in the errors. Takes the errors as
/// independent.
BodyMotion compose(const BodyMotion& first, const BodyMotion& second);

/// Transforms points from the robot's frame before a motion to its frame after it (motion compensation).
class MotionCompensation {
 public:
  /// `motion` must outlive it.
  explicit MotionCompensation(const BodyMotion& motion);
  /// Transforms a point in the robot's frame and its covariance, which grows by that of the motion.
  void apply(Eigen::Vector2d& at, Eigen::Matrix2d& covariance) const;

 private:
  const BodyMotion& motion_;
  Eigen::Matrix2d back_;
};

/// Predicts a pose as an extended Kalman filter does. A negative part of the motion's covariance that would
/// undo more than a fifth of a variance counts as 0.
PoseEstimate predict_pose(const PoseEstimate& estimate, const BodyMotion& motion);

/// Predicts a pose that is not the one whose error the motion may undo: the negative part counts as 0.
PoseEstimate predict_other_pose(const PoseEstimate& estimate, const BodyMotion& motion);

/// Returns lower triangular L with L L' = covariance + tiny, with zero rows where there is no noise.
/// Accepts positive semidefinite covariances, such as those of a robot that cannot slip sideways. Negative
/// eigenvalues count as 0.
Eigen::Matrix3d square_root(const Eigen::Matrix3d& symmetric);

}  // namespace waymark::localization
