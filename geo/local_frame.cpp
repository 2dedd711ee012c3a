// SPDX-License-Identifier: Apache-2.0
#include "geo/local_frame.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <mutex>
#include <optional>

namespace waymark::inline geo {

struct LocalFrame::Conversion {
  Conversion(const Crs& of_map, const Point<MapCrs>& at) : crs(of_map), origin(at) {
    if (crs.kind() == CrsKind::local) {
      metres_per_unit = crs.metres_per_unit();
      return;
    }
    const Crs geographic = geographic_crs(crs);
    if (crs.kind() == CrsKind::projected) {
      to_degrees.emplace(crs, geographic);
      from_degrees.emplace(geographic, crs);
    }
    const Eigen::Vector3d degrees = through(to_degrees, at.xyz);
    plane.emplace(degrees.y(), degrees.x(), degrees.z(),
                  GeographicLib::Geocentric(crs.body().equatorial_radius, crs.body().flattening));
  }

  // The mutex guards the transform, which is not thread-safe.
  Eigen::Vector3d through(const std::optional<CrsTransform>& transform, const Eigen::Vector3d& point) const {
    if (!transform) return point;
    const std::scoped_lock lock(mutex);
    const auto [x, y] = (*transform)(point.x(), point.y());
    return {x, y, point.z()};
  }

  Crs crs;
  Point<MapCrs> origin;
  double metres_per_unit = 1;                            // of a local CRS
  std::optional<GeographicLib::LocalCartesian> plane;    // absent for a local CRS
  std::optional<CrsTransform> to_degrees, from_degrees;  // for a projected CRS
  mutable std::mutex mutex;
};

LocalFrame::LocalFrame(const Crs& crs, const Point<MapCrs>& origin)
    : conversion_(std::make_shared<const Conversion>(crs, origin)) {}

const Crs& LocalFrame::crs() const {
  return conversion_->crs;
}

const Point<MapCrs>& LocalFrame::origin() const {
  return conversion_->origin;
}

Point<MapFrame> LocalFrame::map_frame_from_crs(const Point<MapCrs>& point) const {
  const Conversion& c = *conversion_;
  if (!c.plane) {
    const Eigen::Vector3d shift = point.xyz - c.origin.xyz;
    return {{shift.x() * c.metres_per_unit, shift.y() * c.metres_per_unit, shift.z()}};
  }
  const Eigen::Vector3d degrees = c.through(c.to_degrees, point.xyz);
  Point<MapFrame> local;
  c.plane->Forward(degrees.y(), degrees.x(), degrees.z(), local.xyz.x(), local.xyz.y(), local.xyz.z());
  return local;
}

Point<MapCrs> LocalFrame::crs_from_map_frame(const Point<MapFrame>& point) const {
  const Conversion& c = *conversion_;
  if (!c.plane) {
    const Eigen::Vector3d& p = point.xyz;
    return {c.origin.xyz + Eigen::Vector3d(p.x() / c.metres_per_unit, p.y() / c.metres_per_unit, p.z())};
  }
  Eigen::Vector3d degrees;
  c.plane->Reverse(point.xyz.x(), point.xyz.y(), point.xyz.z(), degrees.y(), degrees.x(), degrees.z());
  return {c.through(c.from_degrees, degrees)};
}

}  // namespace waymark::inline geo
