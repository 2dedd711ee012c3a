// SPDX-License-Identifier: Apache-2.0
#include "geo/axes_rotation.hpp"

#include <Eigen/Core>
#include <cmath>

#include "core/units.hpp"

namespace waymark::inline geo {
namespace {

// Returns the metres per unit of x and of y at a position, up to a common factor for all of a CRS.
Eigen::Vector2d unit_lengths(const Crs& crs, double y) {
  if (crs.kind() != CrsKind::geographic) return Eigen::Vector2d::Constant(crs.metres_per_unit());
  const double latitude = y * kRadiansPerDegree;
  const double f = crs.body().flattening, e2 = f * (2 - f), sine = std::sin(latitude);
  const double normal = crs.body().equatorial_radius / std::sqrt(1 - e2 * sine * sine);
  const double meridional = normal * (1 - e2) / (1 - e2 * sine * sine);
  return Eigen::Vector2d(normal * std::cos(latitude), meridional) * kRadiansPerDegree;
}

}  // namespace

double axes_rotation(const CrsTransform& transform, const Crs& from, const Crs& to, double x, double y) {
  constexpr double kStep = 5;  // metres: rounding of coordinates turns it by 1e-9
  const Eigen::Vector2d from_unit = unit_lengths(from, y);
  const auto at = [&](double along_x, double along_y) {
    const auto there = transform(x + kStep * along_x / from_unit.x(), y + kStep * along_y / from_unit.y());
    return Eigen::Vector2d(there.x, there.y);
  };
  const Eigen::Vector2d to_unit = unit_lengths(to, at(0, 0).y());
  const auto along = [&](double along_x, double along_y) -> Eigen::Vector2d {
    Eigen::Vector2d d = at(along_x, along_y) - at(-along_x, -along_y);
    if (to.kind() == CrsKind::geographic) d.x() = std::remainder(d.x(), 360.0);
    return d.cwiseProduct(to_unit);
  };
  const Eigen::Vector2d u = along(1, 0), v = along(0, 1);
  const double rotation = std::atan2(u.y() - v.x(), u.x() + v.y());  // polar decomposition
  return std::isfinite(rotation) ? rotation : 0;
}

}  // namespace waymark::inline geo
