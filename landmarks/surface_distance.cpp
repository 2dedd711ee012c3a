// SPDX-License-Identifier: Apache-2.0
#include "landmarks/surface_distance.hpp"

#include <GeographicLib/Geocentric.hpp>
#include <mutex>

namespace waymark::inline landmarks {

struct SurfaceDistance::ToDegrees {
  explicit ToDegrees(const Crs& crs) : transform(crs, geographic_crs(crs)) {}
  std::mutex mutex;  // CrsTransform is not thread-safe
  CrsTransform transform;
};

SurfaceDistance::SurfaceDistance(const Crs& crs) : crs_(crs) {
  if (crs.kind() != CrsKind::local) geodesic_.emplace(crs.body());
  if (crs.kind() == CrsKind::projected) to_degrees_ = std::make_unique<ToDegrees>(crs);
}
SurfaceDistance::~SurfaceDistance() = default;

Eigen::Vector2d SurfaceDistance::position(const Point<MapCrs>& point) const {
  if (!to_degrees_) return point.xyz.head<2>();
  const std::scoped_lock lock(to_degrees_->mutex);
  const auto [x, y] = to_degrees_->transform(point.xyz.x(), point.xyz.y());
  return {x, y};
}

double SurfaceDistance::distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  if (!geodesic_) return (a - b).norm() * crs_.metres_per_unit();
  return geodesic_->distance({a.x(), a.y()}, {b.x(), b.y()});
}

Eigen::Vector3d SurfaceDistance::cartesian(const Eigen::Vector2d& position) const {
  if (!geodesic_) return {position.x() * crs_.metres_per_unit(), position.y() * crs_.metres_per_unit(), 0};
  const GeographicLib::Geocentric body(crs_.body().equatorial_radius, crs_.body().flattening);
  Eigen::Vector3d point;
  body.Forward(position.y(), position.x(), 0, point.x(), point.y(), point.z());
  return point;
}

}  // namespace waymark::inline landmarks
