// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "localization/body_motion.hpp"
namespace waymark {

/// Robot and landmarks in one Gaussian. Only what lies near the robot, the active part A, is kept up to date;
/// what the measurements there mean for the passive rest B is gathered in three small matrices and carried
/// out when the robot leaves the neighbourhood (compressed filter, Guivant & Nebot 2001). The result is that
/// of the full filter to rounding; an update costs O(A^2) instead of O((A + B)^2).
class SlamState {
 public:
  using Slot = std::size_t;  ///< of a landmark; never used twice

  explicit SlamState(const PoseEstimate& start);

  const Pose2& pose() const { return pose_; }
  Eigen::Matrix3d covariance() const { return paa_.topLeftCorner<3, 3>(); }
  std::size_t landmarks() const { return active_.size() + passive_.size(); }
  std::span<const Slot> active() const { return active_; }

  /// Of any landmark; of a passive one as it was when it became passive.
  const Eigen::Vector2d& at(Slot slot) const { return at_[slot]; }
  Eigen::Matrix2d covariance(Slot slot) const;
  /// Covariance of an active landmark with the robot.
  Eigen::Matrix<double, 2, 3> cross(Slot slot) const;

  void move(const BodyMotion& motion);

  /// What one sighting says: innovation, its derivatives, noise. The landmark is active.
  struct Correction {
    Slot slot = 0;
    Eigen::Vector2d innovation;
    Eigen::Matrix<double, 2, 3> by_pose;
    Eigen::Matrix2d by_landmark, noise;
  };
  /// Kalman update by all corrections at once, Joseph form.
  void update(std::span<const Correction> corrections);

  /// A landmark placed from where the robot is: `by_pose` its derivative by the pose, `own` the rest of its
  /// covariance. Active.
  Slot add(const Eigen::Vector2d& at, const Eigen::Matrix<double, 2, 3>& by_pose, const Eigen::Matrix2d& own);
  /// A landmark known from elsewhere. Active.
  Slot add(const Eigen::Vector2d& at, const Eigen::Matrix2d& covariance);
  /// Forgets an active landmark.
  void remove(Slot slot);

  /// Brings all up to date, and makes active what lies within `radius` metres of the robot.
  void focus(double radius);

  /// The whole covariance, robot first, then the landmarks in the order of `order`. Everything is up to date
  /// after focus() only.
  Eigen::MatrixXd whole(std::vector<Slot>& order) const;

 private:
  Eigen::Index row(Slot slot) const { return 3 + 2 * static_cast<Eigen::Index>(place_[slot]); }
  Slot append(const Eigen::Vector2d& at);

  Pose2 pose_;
  std::vector<Eigen::Vector2d> at_;  // by slot
  std::vector<std::size_t> place_;   // by slot: in active_ or passive_
  std::vector<Slot> active_, passive_;
  Eigen::MatrixXd paa_;        // robot and active landmarks
  Eigen::MatrixXd pab_, pbb_;  // as of the last focus(); rows of pab_: what was active then
  Eigen::MatrixXd phi_, psi_;  // P_AB now = phi P_AB then; P_BB now = P_BB then - P_BA psi P_AB
  Eigen::VectorXd theta_;      // x_B now = x_B then + P_BA theta
};

}  // namespace waymark
