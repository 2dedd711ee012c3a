// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/frame_errors.hpp"
#include "localization/odometry_drift.hpp"
namespace waymark::localization {

/// Estimates errors that persist beside any localizer, from its estimates before and after each update.
/// - The localizer tracks the pose relative to landmarks. The errors and that pose have one Gaussian.
///   Landmarks see the pose alone, so what they teach about the errors follows from their covariance with the
///   pose (regression; exact for a Kalman filter).
/// - Motions are corrected by the estimate, and their covariance includes what is unknown of it and its
///   covariance with the pose. It may have a negative part, which the Kalman filters use; what draws samples
///   or inverts it counts that part as 0 (positive_part).
/// - With errors of frames, the robot's pose is the localizer's less the shift of the map and the offset of
///   the sensors (robot()). Absolute fixes measure that pose.
class PersistentErrors {
 public:
  static constexpr int kCount = 10;
  /// Scale, slip, sideways, yaw rate, curvature; shift of the map x, y; sensors forward, left, yaw.
  using Errors = Eigen::Vector<double, kCount>;
  using Covariance = Eigen::Matrix<double, kCount, kCount>;

  explicit PersistentErrors(const OdometryDrift& drift, const FrameErrors& frames = {});
  bool any() const { return drift_.any() || frames_.any(); }

  /// Returns the motion corrected and with the variance of what is unknown, for a localizer at `pose`.
  BodyMotion correct(const PoseEstimate& pose, const BodyMotion& motion, double seconds);
  /// Learns from an update of the pose by landmarks. A jump of more than five standard deviations teaches
  /// nothing.
  void learn(const PoseEstimate& before, const PoseEstimate& after);

  /// Follows an update of the pose that is not trusted: it teaches nothing, but the pose remains correlated
  /// with the errors (Schmidt 1966). Without that, an error that persists would count as new at each set.
  /// What the pose gets wider by, beyond the noise of samples, is independent of the errors.
  void consider(const PoseEstimate& before, const PoseEstimate& after);

  /// Returns the robot's pose in the reference frame, of a localizer at `pose`.
  PoseEstimate robot(const PoseEstimate& pose) const;
  /// Returns the place of the sensors on the robot, forward, left and yaw beside that of the log;
  /// `std::nullopt` if it is known.
  std::optional<PoseEstimate> mount() const;
  /// Returns a fix of the robot as one of the localizer's pose, with the variance of what separates them.
  GnssFix relative_to_map(const GnssFix& fix, const PoseEstimate& pose) const;
  HeadingFix relative_to_map(const HeadingFix& fix, const PoseEstimate& pose) const;
  /// Learns from a fix of the robot by which the localizer's pose was updated.
  void learn(const GnssFix& fix, const PoseEstimate& before, const PoseEstimate& after);
  void learn(const HeadingFix& fix, const PoseEstimate& before, const PoseEstimate& after);

  /// Changes the standard deviation of the shift. What was learnt keeps its place in standard deviations.
  void scale_shift(double sd);

  /// Keeps the errors, with their first variance, and takes the pose for a new one: after relocalization.
  void restart();

  const Errors& errors() const { return mean_; }
  const Covariance& covariance() const { return covariance_; }

 private:
  using PoseErrors = Eigen::Matrix<double, 3, kCount>;
  struct Robot;
  Robot robot_by(const PoseEstimate& pose) const;
  template <int Rows>
  void learn_fix(int first_row, const Eigen::Vector<double, Rows>& difference,
                 const Eigen::Matrix<double, Rows, Rows>& noise, const PoseEstimate& before,
                 const PoseEstimate& after);
  void limit();

  OdometryDrift drift_;
  FrameErrors frames_;
  Errors mean_ = Errors::Zero();
  Covariance covariance_;
  PoseErrors with_pose_ = PoseErrors::Zero();  // of pose and errors
};

}  // namespace waymark::localization
