// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/robot_readings.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace waymark::importers {

localization::Pose2 level_pose(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(), std::atan2(pose(1, 0), pose(0, 0))};
}

localization::LaserScan laser_scan(double first_angle, double angle_step, float min_range, float max_range,
                                   std::vector<float> ranges, std::vector<float> intensities) {
  if (!(std::isfinite(first_angle) && std::abs(angle_step) > 0 && std::isfinite(angle_step) &&
        max_range > 0) ||
      ranges.empty())
    throw std::runtime_error("a scan has no beams, or its angles or ranges are not finite");
  if (intensities.size() != ranges.size()) intensities.clear();
  for (float& r : ranges)
    if (!(r >= min_range)) r = 0;
  return {.robot_from_sensor = {},
          .first_angle = first_angle,
          .angle_step = angle_step,
          .ranges = std::move(ranges),
          .max_range = max_range,
          .intensities = std::move(intensities)};
}

bool is_level(const Eigen::Isometry3d& robot_from_sensor) {
  constexpr double kMaxTilt = 0.2;  // rad: a level scan 10 m away is then 2 m higher or lower
  return std::abs(robot_from_sensor(2, 2)) >= std::cos(kMaxTilt);
}

void mount(localization::LaserScan& scan, const Eigen::Isometry3d& robot_from_sensor) {
  scan.robot_from_sensor = level_pose(robot_from_sensor);
  if (robot_from_sensor(2, 2) >= 0) return;
  // Seen from above, the beams of a scanner that hangs upside down run from right to left in the other order.
  scan.first_angle = -(scan.first_angle + scan.angle_step * static_cast<double>(scan.ranges.size() - 1));
  std::ranges::reverse(scan.ranges);
  std::ranges::reverse(scan.intensities);
}

std::optional<Eigen::Matrix2d> horizontal_covariance(const Covariance3& covariance, int type) {
  constexpr int kUnknown = 0, kKnown = 3;  // of 1, approximated, and 2, diagonal, only the diagonal counts
  if (type < kUnknown || type > kKnown)
    throw std::runtime_error("there is no type of covariance " + std::to_string(type));
  if (type == kUnknown) return {};
  const double aside = type == kKnown ? covariance[1] : 0;
  Eigen::Matrix2d horizontal;
  horizontal << covariance[0], aside, aside, covariance[4];
  if (!horizontal.allFinite()) throw std::runtime_error("the covariance of a position is not finite");
  const Eigen::Vector2d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(horizontal).eigenvalues();
  if (!(variances[1] > 0)) return {};
  if (variances[0] > 0) return horizontal;
  return Eigen::Matrix2d(variances[1] * Eigen::Matrix2d::Identity());
}

localization::GnssFix fix_of_antenna(double longitude, double latitude,
                                     const std::optional<Eigen::Matrix2d>& covariance, double arm) {
  constexpr double kUnstatedSd = 3;  // m, as of a record `gnss` without `sd`
  if (!covariance) return {{longitude, latitude}, std::hypot(kUnstatedSd, arm)};
  return localization::fix_of_covariance({longitude, latitude},
                                         *covariance + arm * arm * Eigen::Matrix2d::Identity());
}

}  // namespace waymark::importers
