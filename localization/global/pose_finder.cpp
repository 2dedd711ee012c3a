// SPDX-License-Identifier: Apache-2.0
#include "localization/global/pose_finder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::localization {
namespace {

constexpr double kElsewhere = 16.3;     // squared distance of two poses: 99.9 % of chi-square, 3 dof
constexpr double kUnknownExtent = 1e5;  // m, standard deviation
constexpr int kMaxInterval = 5;         // sets
constexpr double kMinElsewhere = 1;     // m: a filter recovers from less by itself

}  // namespace

int search_interval(std::int64_t sets) {
  return static_cast<int>(std::clamp<std::int64_t>(sets / 4, 1, kMaxInterval));
}

PoseEstimate pose_anywhere(const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2d centre = box.isEmpty() ? Eigen::Vector2d(0, 0) : box.center();
  const Eigen::Vector2d variance =
      box.isEmpty() ? Eigen::Vector2d::Constant(kUnknownExtent * kUnknownExtent)
                    : Eigen::Vector2d(box.sizes().cwiseAbs2() / 12 + Eigen::Vector2d::Ones());
  const Eigen::Vector3d all(variance.x(), variance.y(), std::numbers::pi * std::numbers::pi / 3);
  return {{centre.x(), centre.y(), 0}, all.asDiagonal()};
}

double wrong_probability(std::span<const double> log_false_alarms) {
  if (log_false_alarms.empty()) return 1;
  const double first = log_false_alarms[0];
  double others = std::exp(first);  // over the odds of the first
  for (const double other : log_false_alarms.subspan(1)) others += std::exp(first - other);
  return std::isfinite(others) ? others / (1 + others) : 1;
}

bool are_distinct(const PoseEstimate& found, const PoseEstimate& other) {
  const Eigen::Vector3d d(found.pose.x - other.pose.x, found.pose.y - other.pose.y,
                          wrap_angle(found.pose.yaw - other.pose.yaw));
  const Eigen::Matrix3d both = found.covariance + other.covariance + 1e-9 * Eigen::Matrix3d::Identity();
  return d.head<2>().norm() > kMinElsewhere && !(d.dot(both.inverse() * d) < kElsewhere);
}

}  // namespace waymark::localization
