// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/web_projection.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/units.hpp"

namespace waymark::exporters {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// On Earth WGS 84, as all web maps have it; on other bodies the datum of the map.
Crs lonlat_of(const Crs& crs) {
  if (crs.kind() == CrsKind::local) return crs;
  return crs.body().name == earth().name ? Crs::from_text("EPSG:4326") : geographic_crs(crs);
}

}  // namespace

double web_longitude(double world_x) {
  return 360 * world_x - 180;
}

double web_latitude(double world_y) {
  return std::atan(std::sinh(kTurn * (0.5 - world_y))) / kRadiansPerDegree;
}

WebPlane web_plane(const Crs& crs, const std::optional<MapBox>& extent) {
  if (crs.kind() == CrsKind::local) return WebPlane::metres;
  if (crs.kind() == CrsKind::geographic || !extent) return WebPlane::mercator;
  try {
    const LonLatFootprint area = lonlat_footprint(*extent, crs);
    return area.south < -kMaxWebLatitude || area.north > kMaxWebLatitude ? WebPlane::metres
                                                                         : WebPlane::mercator;
  } catch (const Error&) {
    return WebPlane::metres;  // a corner has no longitude and latitude: only the plane shows all
  }
}

WebProjection::WebProjection(const Crs& crs, WebPlane plane)
    : plane_(plane),
      crs_(crs),
      lonlat_(lonlat_of(crs)),
      to_lonlat_(crs_, lonlat_),
      from_lonlat_(lonlat_, crs_) {}

std::optional<Eigen::Vector2d> WebProjection::to_world(double x, double y) const {
  Eigen::Vector2d world;
  if (plane_ == WebPlane::metres) {
    world =
        Eigen::Vector2d(0.5, 0.5) + Eigen::Vector2d(x, -y) * (crs_.metres_per_unit() / kTurn / kWebRadius);
    if (!(world.x() >= 0 && world.x() < 1)) return std::nullopt;
  } else {
    const CrsTransform::XY at = to_lonlat_(x, y);
    if (!(std::abs(at.y) <= kMaxWebLatitude)) return std::nullopt;
    world = {at.x / 360 + 0.5, 0.5 - std::asinh(std::tan(at.y * kRadiansPerDegree)) / kTurn};
    world.x() -= std::floor(world.x());
    if (!(world.x() < 1)) world.x() = 0;  // a tiny negative number has the floor -1, and rounds to 1
  }
  if (!(world.y() >= 0 && world.y() < 1)) return std::nullopt;
  return world;
}

Eigen::Vector2d WebProjection::from_world(const Eigen::Vector2d& world) const {
  if (plane_ == WebPlane::metres)
    return Eigen::Vector2d(world.x() - 0.5, 0.5 - world.y()) * (kTurn * kWebRadius / crs_.metres_per_unit());
  const CrsTransform::XY at = from_lonlat_(web_longitude(world.x()), web_latitude(world.y()));
  return {at.x, at.y};
}

double WebProjection::world_width(double world_y) const {
  if (plane_ == WebPlane::metres) return kTurn * kWebRadius;
  const Body& body = crs_.body();
  const double latitude = web_latitude(world_y) * kRadiansPerDegree;
  const double e2 = body.flattening * (2 - body.flattening);
  const double sine = std::sin(latitude);
  return kTurn * body.equatorial_radius * std::cos(latitude) / std::sqrt(1 - e2 * sine * sine);
}

}  // namespace waymark::exporters
