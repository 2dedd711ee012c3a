// SPDX-License-Identifier: Apache-2.0
#include "localization/global/pose_finder.hpp"

#include <Eigen/LU>

namespace waymark::localization {
namespace {

constexpr double kElsewhere = 16.3;  // squared distance of two poses: 99.9 % of chi-square, 3 dof
constexpr double kMinElsewhere = 1;  // m: a filter recovers from less by itself

}  // namespace

bool are_distinct(const PoseEstimate& found, const PoseEstimate& other) {
  const Eigen::Vector3d d(found.pose.x - other.pose.x, found.pose.y - other.pose.y,
                          wrap_angle(found.pose.yaw - other.pose.yaw));
  const Eigen::Matrix3d both = found.covariance + other.covariance + 1e-9 * Eigen::Matrix3d::Identity();
  return d.head<2>().norm() > kMinElsewhere && !(d.dot(both.inverse() * d) < kElsewhere);
}

}  // namespace waymark::localization
