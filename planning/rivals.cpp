// SPDX-License-Identifier: Apache-2.0
#include "planning/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/units.hpp"

namespace waymark::planning {
namespace {

constexpr double kFarthest = 8;  // Mahalanobis distance: Q(4) is 3e-5

/// Returns the distance of the nearest other landmark of the type, found in rings of doubling radius.
double nearest_of_type(const localization::LandmarkGrid& map, std::uint32_t landmark) {
  const double whole = map.bounds().diagonal().norm();
  for (double radius = 1;; radius *= 2) {
    double min_distance = std::numeric_limits<double>::infinity();
    map.near(map[landmark].at, radius, [&](std::uint32_t k) {
      if (k != landmark && map[k].type == map[landmark].type)
        min_distance = std::min(min_distance, (map[k].at - map[landmark].at).norm());
    });
    if (std::isfinite(min_distance) || radius > whole) return min_distance;
  }
}

/// Returns the covariance of where a sighting of a landmark appears in the map: pose and noise of the sensor.
Eigen::Matrix2d sighting_covariance(const Symmetric3& belief, const Eigen::Vector2d& to,
                                    const SensorCoverage& sensor) {
  const Eigen::Vector2d w(-to.y(), to.x());  // where a yaw error moves it
  Eigen::Matrix2d c;
  c << belief.xx, belief.xy, belief.xy, belief.yy;
  const Eigen::Vector2d by_yaw(belief.xt, belief.yt);
  c += by_yaw * w.transpose() + w * by_yaw.transpose() + belief.tt * w * w.transpose();
  const double bearing = sensor.bearing_sd * kRadiansPerDegree;
  c += bearing * bearing * w * w.transpose();
  const Eigen::Vector2d u = to.normalized();
  return c + sensor.range_sd * sensor.range_sd * u * u.transpose();
}

}  // namespace

Rivals::Rivals(const localization::LandmarkGrid& map) : map_(map) {
  for (std::uint32_t i = 0; i < map.size(); ++i) nearest_.push_back(nearest_of_type(map, i));
}

double Rivals::expected(const Symmetric3& belief, const localization::Pose2& pose, std::uint32_t landmark,
                        const SensorCoverage& sensor) const {
  const localization::MapLandmark& l = map_[landmark];
  const Eigen::Vector2d to = l.at - pose.at();
  const Eigen::Matrix2d sighting = sighting_covariance(belief, to, sensor) + l.covariance;
  const double largest_sd = std::sqrt(sighting.trace()) + map_.largest_sd();
  const bool has_range = sensor.range_sd > 0;
  if (has_range && nearest_[landmark] > kFarthest * largest_sd) return 0;
  // Bearings alone do not distinguish near from far: every landmark in range that lies in the direction is a
  // rival.
  const Eigen::Vector2d across = Eigen::Vector2d(-to.y(), to.x()).normalized();
  double rivals = 0;
  const auto count = [&](std::uint32_t k) {
    const localization::MapLandmark& other = map_[k];
    if (k == landmark || other.type != l.type) return;
    const Eigen::Matrix2d covariance = sighting + other.covariance;
    const Eigen::Vector2d apart = other.at - l.at;
    double square = 0;
    if (has_range) {
      // Most are beyond by far: the inverse is not needed.
      const double x = apart.x(), y = apart.y();
      const double scaled =
          covariance(1, 1) * x * x - (covariance(0, 1) + covariance(1, 0)) * x * y + covariance(0, 0) * y * y;
      if (scaled > (1 + 1e-6) * kFarthest * kFarthest * covariance.determinant()) return;
      square = apart.dot(covariance.inverse() * apart);
    } else {
      const Eigen::Vector2d there = other.at - pose.at();
      if (!(there.norm() > 0)) return;
      const double angle = std::atan2(to.x() * there.y() - to.y() * there.x(), to.dot(there));
      const double sd = std::sqrt(across.dot(covariance * across)) / to.norm();
      square = angle * angle / (sd * sd);
    }
    const double d = std::sqrt(square);
    if (d < kFarthest) rivals += other.quality * std::erfc(d / 2 / std::numbers::sqrt2) / 2;
  };
  if (has_range)
    map_.near(l.at, kFarthest * largest_sd, count);
  else
    map_.near(pose.at(), sensor.range, count);
  return rivals;
}

}  // namespace waymark::planning
