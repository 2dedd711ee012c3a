// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/pose2.hpp"
namespace waymark::localization {

/// A position measured by an absolute sensor such as a GNSS receiver.
struct GnssFix {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double sd = 1;  ///< m, of each coordinate; with a covariance that of the least certain direction
  std::optional<Eigen::Matrix2d> covariance = {};  ///< m2, of x and y; unknown: `sd` in all directions

  Eigen::Matrix2d noise() const {
    return covariance ? *covariance : Eigen::Matrix2d(sd * sd * Eigen::Matrix2d::Identity());
  }
};

/// Returns a fix of a covariance, which must be positive definite.
GnssFix fix_of_covariance(const Eigen::Vector2d& at, const Eigen::Matrix2d& covariance);

/// A heading measured by an absolute sensor: compass, sun or stars.
struct HeadingFix {
  double yaw = 0, sd = 0.1;  ///< rad
};

/// What a fix of some numbers says of a pose.
template <int Rows>
struct FixInnovation {
  Eigen::Matrix<double, Rows, 1> value;  ///< measured less estimated; m, rad
  Eigen::Matrix<double, Rows, 3> by_pose;
  Eigen::Matrix<double, Rows, Rows> noise;
};
FixInnovation<2> innovation(const Pose2& pose, const GnssFix& fix);
FixInnovation<1> innovation(const Pose2& pose, const HeadingFix& fix);

/// Result of a Kalman update by a fix.
struct FixUpdate {
  PoseEstimate estimate;   ///< Joseph form
  double squares = 0;      ///< v' S^-1 v before the update
  double log_density = 0;  ///< ln N(v; 0, S)
};
/// Updates a pose by a measured position (Kalman).
FixUpdate update_pose(const PoseEstimate& estimate, const GnssFix& fix);
/// Updates a pose by a measured heading (Kalman).
FixUpdate update_pose(const PoseEstimate& estimate, const HeadingFix& fix);

/// Gate for fixes. Rejects a single outlier, and accepts a fix after ten rejections in a row.
class FixGate {
 public:
  /// Returns whether a fix of `rows` numbers with this squared distance passes. After `kPatience`
  /// rejections in a row the next fix passes.
  bool pass(double squares, int rows);
  /// Returns whether the last fix passed although it contradicts the estimate. The filter should then widen
  /// its covariance.
  bool was_forced() const { return forced_; }

 private:
  static constexpr int kPatience = 10;
  int rejected_ = 0;
  bool forced_ = false;
};

}  // namespace waymark::localization
