// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "core/options.hpp"
#include "localization/body_motion.hpp"
namespace waymark::localization {

/// Standard deviations of odometry errors that persist; 0: none. Independent errors are OdometryNoise.
struct OdometryDrift {
  double scale_sd = 0;         ///< of the distance driven, relative, constant: wheel radius, mean slip
  double slip_sd = 0;          ///< of the distance driven, relative, correlated over `drift_distance`
  double sideways_sd = 0;      ///< m sideways per metre driven, correlated over `drift_distance`
  double drift_distance = 10;  ///< m until slip and sideways drift have fallen to 1/e
  double yaw_rate_sd = 0;      ///< rad/s, constant: bias of the gyro
  double curvature_sd = 0;     ///< rad of yaw per metre driven, constant: wheels of unequal diameter

  void describe(OptionVisitor& option);
  bool any() const {
    return scale_sd > 0 || slip_sd > 0 || sideways_sd > 0 || yaw_rate_sd > 0 || curvature_sd > 0;
  }
  bool operator==(const OdometryDrift&) const = default;
};

/// Estimates persistent odometry errors beside any localizer, from its estimates before and after each
/// update.
/// - The five errors and the pose have one Gaussian. A measurement sees the pose alone, so what it teaches
///   about the errors follows from their covariance with the pose (regression; exact for a Kalman filter).
/// - Motions are corrected by the estimate, and their covariance includes what is unknown of it and its
///   covariance with the pose. It may have a negative part, which the Kalman filters use; what draws samples
///   or inverts it counts that part as 0 (positive_part).
class DriftEstimator {
 public:
  using Errors = Eigen::Vector<double, 5>;  ///< scale, slip, sideways, yaw rate, curvature

  explicit DriftEstimator(const OdometryDrift& prior);
  /// Returns the motion corrected and with the variance of what is unknown, for a robot at `pose`.
  BodyMotion correct(const PoseEstimate& pose, const BodyMotion& motion, double seconds);
  /// Learns from an update of the pose. A jump of more than five standard deviations teaches nothing.
  void learn(const PoseEstimate& before, const PoseEstimate& after);

  /// Follows an update of the pose that is not trusted: it teaches nothing, but the pose remains correlated
  /// with the errors (Schmidt 1966). Without that, an error that persists would count as new at each set.
  void consider(const PoseEstimate& before, const PoseEstimate& after);

  /// Keeps the errors, with their first variance, and takes the pose for a new one: after relocalization.
  void restart();

  const Errors& errors() const { return mean_; }
  const Eigen::Matrix<double, 5, 5>& covariance() const { return covariance_; }

 private:
  OdometryDrift prior_;
  Errors mean_ = Errors::Zero();
  Eigen::Matrix<double, 5, 5> covariance_;
  Eigen::Matrix<double, 3, 5> with_pose_ = Eigen::Matrix<double, 3, 5>::Zero();  // of pose and errors
};

}  // namespace waymark::localization
