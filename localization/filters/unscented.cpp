// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <stdexcept>

#include "localization/filters/kalman.hpp"

namespace waymark::localization {
namespace {

// Returns lower triangular L with L L' = m m', without forming the product. Modified Gram-Schmidt over the
// rows (Golub and Van Loan 2013, 5.2.8), whose triangular factor is as exact as Householder's.
template <int Columns>
Eigen::Matrix3d lower_root(Eigen::Matrix<double, 3, Columns> m) {
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    root(i, i) = m.row(i).norm();
    if (!(root(i, i) > 0)) continue;
    m.row(i) /= root(i, i);
    for (int j = i + 1; j < 3; ++j) {
      root(j, i) = m.row(j).dot(m.row(i));
      m.row(j) -= root(j, i) * m.row(i);
    }
  }
  return root;
}

double circular_mean(const double* angles, int count) {
  double c = 0, s = 0;
  for (int i = 0; i < count; ++i) c += std::cos(angles[i]), s += std::sin(angles[i]);
  return std::atan2(s, c);
}

/// A Gaussian by its mean and a lower triangular root of its covariance.
struct RootedPose {
  Pose2 pose;
  Eigen::Matrix3d root;
};

// Sigma points of pose and step together: 6 dimensions, 12 points of equal weight.
RootedPose predict_root(const RootedPose& before, const BodyMotion& motion) {
  constexpr int kPoints = 12;
  const Eigen::Matrix3d noise = square_root(motion.covariance);
  const double reach = std::sqrt(6.0);
  Eigen::Matrix<double, 3, kPoints> points;
  double yaws[kPoints];
  for (int i = 0; i < 3; ++i)
    for (int sign = 0; sign < 2; ++sign) {
      const double k = sign ? -reach : reach;
      const Pose2 by_pose = pose_of(before.pose.vector() + k * before.root.col(i)) * motion.step;
      const Pose2 by_step = before.pose * pose_of(motion.step.vector() + k * noise.col(i));
      points.col(4 * i + 2 * sign) = by_pose.vector();
      points.col(4 * i + 2 * sign + 1) = by_step.vector();
    }
  for (int i = 0; i < kPoints; ++i) yaws[i] = points(2, i);
  Eigen::Vector3d mean = points.rowwise().mean();
  mean.z() = circular_mean(yaws, kPoints);
  points.colwise() -= mean;
  for (int i = 0; i < kPoints; ++i) points(2, i) = wrap_angle(points(2, i));
  return {pose_of(mean), lower_root<kPoints>(points / std::sqrt(double{kPoints}))};
}

}  // namespace

PoseEstimate ukf_predict(const PoseEstimate& estimate, const BodyMotion& motion) {
  const RootedPose after = predict_root({estimate.pose, square_root(estimate.covariance)}, motion);
  return {after.pose, after.root * after.root.transpose()};
}

UnscentedKalman::UnscentedKalman(const PoseEstimate& start, LandmarkMatcher matcher, KalmanOptions options)
    : KalmanLocalizer(std::move(matcher), options),
      pose_(start.pose),
      root_(square_root(start.covariance)),
      errors_(options.error_memory_distance) {
  if (!start.pose.finite() || !start.covariance.allFinite())
    throw std::invalid_argument("the start of a filter must be finite");
}

void UnscentedKalman::predict(const BodyMotion& motion) {
  errors_.predict(pose_, motion.step);
  const RootedPose after = predict_root({pose_, root_}, motion);
  pose_ = after.pose, root_ = after.root;
}

void UnscentedKalman::correct(const std::vector<MatchedSighting>& uses, const Pose2& robot_from_sensor) {
  PoseEstimate at = estimate();
  for (const MatchedSighting& use : uses)
    at = errors_.correct_probably(at, *use.seen, robot_from_sensor, *use.landmark, use.trust, use.probability,
                                  true);
  pose_ = at.pose, root_ = square_root(at.covariance);
}

void UnscentedKalman::replace(const PoseEstimate& estimate) {
  errors_.follow(this->estimate(), estimate);
  pose_ = estimate.pose;
  root_ = square_root(estimate.covariance);
}

void UnscentedKalman::widen(double factor) {
  const Eigen::Vector3d sd = (root_ * root_.transpose()).diagonal().cwiseSqrt();
  root_ = clamp_sd(sd * factor).asDiagonal();
  errors_.clear();
}

}  // namespace waymark::localization
