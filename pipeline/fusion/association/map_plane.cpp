// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/map_plane.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace waymark::pipeline {

MapPlane::MapPlane(const Crs& crs) {
  geographic_ = crs.kind() == CrsKind::geographic;
  if (!geographic_) {
    metres_per_unit_ = crs.metres_per_unit();
    return;
  }
  radius_ = crs.body().equatorial_radius;
  const double f = crs.body().flattening;
  eccentricity2_ = f * (2 - f);
}

// Along the parallel (radius N cos phi) and the meridian (radius of curvature M).
Eigen::Vector2d MapPlane::metres_per_degree(double latitude) const {
  const double phi = std::clamp(latitude, -90.0, 90.0) * kRadiansPerDegree;
  const double s = std::sin(phi), w = 1 - eccentricity2_ * s * s;
  const double n = radius_ / std::sqrt(w), m = n * (1 - eccentricity2_) / w;
  return {std::max(n * std::cos(phi), 1e-6 * radius_) * kRadiansPerDegree, m * kRadiansPerDegree};
}

double MapPlane::wrapped(double degrees) {
  return degrees >= -180 && degrees <= 180 ? degrees : std::remainder(degrees, 360.0);
}

Eigen::Vector3d MapPlane::to_cartesian(const Eigen::Vector2d& position) const {
  if (!geographic_) return {position.x() * metres_per_unit_, position.y() * metres_per_unit_, 0};
  const double lambda = position.x() * kRadiansPerDegree, phi = position.y() * kRadiansPerDegree;
  const double s = std::sin(phi), n = radius_ / std::sqrt(1 - eccentricity2_ * s * s);
  return {n * std::cos(phi) * std::cos(lambda), n * std::cos(phi) * std::sin(lambda),
          n * (1 - eccentricity2_) * s};
}

}  // namespace waymark::pipeline
