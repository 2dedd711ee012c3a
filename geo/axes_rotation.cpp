// SPDX-License-Identifier: Apache-2.0
#include "geo/axes_rotation.hpp"

#include <cmath>

#include "core/units.hpp"

namespace waymark::inline geo {
namespace {

constexpr double kStep = 5;  // metres: rounding of coordinates turns the axes by 1e-9

// Returns the metres per unit of x and of y at a position.
Eigen::Vector2d unit_lengths(const Crs& crs, double y) {
  if (crs.kind() != CrsKind::geographic) return Eigen::Vector2d::Constant(crs.metres_per_unit());
  const double latitude = y * kRadiansPerDegree;
  const double f = crs.body().flattening, e2 = f * (2 - f), sine = std::sin(latitude);
  const double normal = crs.body().equatorial_radius / std::sqrt(1 - e2 * sine * sine);
  const double meridional = normal * (1 - e2) / (1 - e2 * sine * sine);
  return Eigen::Vector2d(normal * std::cos(latitude), meridional) * kRadiansPerDegree;
}

// Returns the rotation nearest to what a transform makes of the axes at a position (polar decomposition).
// `there` returns the coordinates of a point so many steps along x and along y in `to`.
template <class There>
double nearest_rotation(const Crs& to, const There& there) {
  const double latitude = to.kind() == CrsKind::geographic ? there(0, 0).y() : 0;
  const Eigen::Vector2d unit = unit_lengths(to, latitude);
  const auto along = [&](double x, double y) -> Eigen::Vector2d {
    Eigen::Vector2d d = there(x, y) - there(-x, -y);
    if (to.kind() == CrsKind::geographic) d.x() = std::remainder(d.x(), 360.0);
    return d.cwiseProduct(unit);
  };
  const Eigen::Vector2d u = along(1, 0), v = along(0, 1);
  const double rotation = std::atan2(u.y() - v.x(), u.x() + v.y());
  return std::isfinite(rotation) ? rotation : 0;
}

}  // namespace

double axes_rotation(const CrsTransform& transform, const Crs& from, const Crs& to, double x, double y) {
  const Eigen::Vector2d step = Eigen::Vector2d::Constant(kStep).cwiseQuotient(unit_lengths(from, y));
  return nearest_rotation(to, [&](double steps_x, double steps_y) {
    const auto there = transform(x + steps_x * step.x(), y + steps_y * step.y());
    return Eigen::Vector2d(there.x, there.y);
  });
}

double grid_rotation(const LocalFrame& frame, const Eigen::Vector2d& position) {
  if (frame.crs().kind() == CrsKind::local) return 0;
  return nearest_rotation(frame.crs(), [&](double steps_x, double steps_y) -> Eigen::Vector2d {
    const Eigen::Vector2d at = position + kStep * Eigen::Vector2d(steps_x, steps_y);
    return frame.crs_from_map_frame({{at.x(), at.y(), 0}}).xyz.head<2>();
  });
}

}  // namespace waymark::inline geo
