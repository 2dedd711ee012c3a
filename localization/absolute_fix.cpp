// SPDX-License-Identifier: Apache-2.0
#include "localization/absolute_fix.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "localization/chi_square.hpp"

namespace waymark::localization {
namespace {

template <int Rows>
FixUpdate linear_update(const PoseEstimate& e, const FixInnovation<Rows>& fix) {
  using Square = Eigen::Matrix<double, Rows, Rows>;
  const Eigen::Matrix3d& p = e.covariance;
  const auto& [v, h, r] = fix;
  const Square s = h * p * h.transpose() + r;
  const Square inverse = s.inverse();
  const Eigen::Matrix<double, 3, Rows> gain = p * h.transpose() * inverse;
  const Eigen::Matrix3d a = Eigen::Matrix3d::Identity() - gain * h;
  const Eigen::Matrix3d after = a * p * a.transpose() + gain * r * gain.transpose();
  const double squares = v.dot(inverse * v);
  return {{pose_of(e.pose.vector() + gain * v), (after + after.transpose()) / 2},
          squares,
          -(squares + std::log(s.determinant()) + Rows * std::log(2 * std::numbers::pi)) / 2};
}

}  // namespace

GnssFix fix_of_covariance(const Eigen::Vector2d& at, const Eigen::Matrix2d& covariance) {
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1];
  return {at, std::sqrt(largest), covariance};
}

FixInnovation<2> innovation(const Pose2& pose, const GnssFix& fix) {
  return {fix.at - pose.at(), Eigen::Matrix<double, 2, 3>::Identity(), fix.noise()};
}

FixInnovation<1> innovation(const Pose2& pose, const HeadingFix& fix) {
  return {Eigen::Matrix<double, 1, 1>(wrap_angle(fix.yaw - pose.yaw)), Eigen::RowVector3d(0, 0, 1),
          Eigen::Matrix<double, 1, 1>(fix.sd * fix.sd)};
}

FixUpdate update_pose(const PoseEstimate& estimate, const GnssFix& fix) {
  return linear_update(estimate, innovation(estimate.pose, fix));
}

FixUpdate update_pose(const PoseEstimate& estimate, const HeadingFix& fix) {
  return linear_update(estimate, innovation(estimate.pose, fix));
}

bool FixGate::pass(double squares, int rows) {
  static const double kGates[] = {chi_square_quantile(0.9999, 1), chi_square_quantile(0.9999, 2)};
  forced_ = false;
  if (squares <= kGates[rows - 1]) {
    rejected_ = 0;
    return true;
  }
  if (++rejected_ < kPatience) return false;
  forced_ = true;
  rejected_ = 0;
  return true;
}

}  // namespace waymark::localization
