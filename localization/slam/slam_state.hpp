// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
namespace waymark::localization {

/// Robot and landmarks in one Gaussian (compressed filter, Guivant & Nebot 2001). Only the active part A
/// near the robot is kept up to date. The effect of its measurements on the passive rest B is collected in
/// three small matrices and applied when the robot leaves the neighbourhood. Equals the full filter to
/// rounding.
/// - An update costs O(A^2).
/// - The matrices have columns only for the robot and the landmarks M measured meanwhile. A change of
///   neighbourhood costs O(M (A + B)^2).
class SlamState {
 public:
  using Slot = std::size_t;  ///< of a landmark; never reused

  explicit SlamState(const PoseEstimate& start);

  const Pose2& pose() const { return pose_; }
  Eigen::Matrix3d covariance() const { return paa_.topLeftCorner<3, 3>(); }
  std::size_t landmarks() const { return active_.size() + passive_.size(); }
  std::span<const Slot> active() const { return active_; }

  /// Returns the position of any landmark, of a line its two numbers (SlamLine). That of a passive one dates
  /// from when it became passive.
  const Eigen::Vector2d& at(Slot slot) const { return at_[slot]; }
  Eigen::Matrix2d covariance(Slot slot) const;
  /// Returns the covariance of an active landmark with the robot.
  Eigen::Matrix<double, 2, 3> cross(Slot slot) const;

  void predict(const BodyMotion& motion);

  /// Innovation of one sighting of an active landmark, its Jacobians and noise.
  struct Correction {
    Slot slot = 0;
    Eigen::Vector2d innovation;
    Eigen::Matrix<double, 2, 3> by_pose;
    Eigen::Matrix2d by_landmark, noise;
    /// Another two numbers that the sighting depends on: the deviation of a piece of wall from its line.
    std::optional<Slot> deviation = {};
    Eigen::Matrix2d by_deviation = Eigen::Matrix2d::Zero();
  };
  /// Returns the squared Mahalanobis distance of all innovations together; infinite if they have none.
  double joint_squares(std::span<const Correction> corrections) const;
  /// Updates by all corrections at once, Joseph form.
  void update(std::span<const Correction> corrections);
  /// Updates by a measurement of the pose alone, Joseph form.
  template <int Rows>
  void update(const FixInnovation<Rows>& fix);

  /// Adds an active landmark measured from the robot. `by_pose`: its Jacobian with respect to the pose;
  /// `own`: the rest of its covariance.
  Slot add(const Eigen::Vector2d& at, const Eigen::Matrix<double, 2, 3>& by_pose, const Eigen::Matrix2d& own);
  /// Adds one that also depends on a slot added since the last focus().
  Slot add(const Eigen::Vector2d& at, const Eigen::Matrix<double, 2, 3>& by_pose, const Eigen::Matrix2d& own,
           Slot deviation, const Eigen::Matrix2d& by_deviation);
  /// Adds an active landmark independent of the state.
  Slot add(const Eigen::Vector2d& at, const Eigen::Matrix2d& covariance);
  /// Sets where a landmark lies whose numbers are no position, and how far it extends from there, m.
  void set_site(Slot slot, const Eigen::Vector2d& centre, double radius);
  /// Removes an active landmark.
  void remove(Slot slot);

  /// Brings the state up to date and activates the landmarks within `radius` metres of the robot.
  void focus(double radius);

  /// Returns the whole covariance, robot first, then the landmarks in `order`. Up to date only after
  /// focus().
  Eigen::MatrixXd full_covariance(std::vector<Slot>& order) const;

 private:
  template <int Rows>
  Eigen::Matrix<double, Rows, 2> with_innovation(Eigen::Index first_row, const Correction& of) const;
  Eigen::Index row(Slot slot) const { return 3 + 2 * static_cast<Eigen::Index>(index_[slot]); }
  Slot append(const Eigen::Vector2d& at);
  void correct(const Eigen::MatrixXd& ph, const Eigen::MatrixXd& h_phi, const Eigen::MatrixXd& s,
               const Eigen::VectorXd& innovation);
  void add_column(Slot slot);
  Eigen::MatrixXd measured_rows() const;

  struct Site {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double radius = 0;
  };
  double distance_to(Slot slot) const;

  Pose2 pose_;
  std::vector<Eigen::Vector2d> at_;        // by slot
  std::vector<std::optional<Site>> site_;  // by slot
  std::vector<std::size_t> index_;         // by slot: in active_ or passive_
  std::vector<Slot> active_, passive_;
  Eigen::MatrixXd paa_;        // robot and active landmarks
  Eigen::MatrixXd pab_, pbb_;  // as of the last focus(); rows of pab_: those active then
  // With P_MB, the rows `measured_` of P_AB: P_AB now = phi P_MB then + rows of P_AB then by `identity_`;
  // P_BB now = P_BB then - P_BM psi P_MB; x_B now = x_B then + P_BM theta.
  Eigen::MatrixXd phi_, psi_;
  Eigen::VectorXd theta_;
  std::vector<Eigen::Index> measured_;
  std::vector<Eigen::Index>
      identity_;  // by index in active_: row of pab_, -1 for those in `measured_` or new
};

}  // namespace waymark::localization
