// SPDX-License-Identifier: Apache-2.0
#include "geo/grid_rotation.hpp"

#include <cmath>

#include "core/units.hpp"

namespace waymark::inline geo {

double grid_rotation(const LocalFrame& frame, const Eigen::Vector2d& position) {
  constexpr double kStep = 5;  // metres: rounding of coordinates turns it by 1e-9
  const Crs& crs = frame.crs();
  if (crs.kind() == CrsKind::local) return 0;
  double x_scale = 1, y_scale = 1;  // metres per degree, up to a common factor
  if (crs.kind() == CrsKind::geographic) {
    const double latitude =
        frame.crs_from_map_frame({{position.x(), position.y(), 0}}).xyz.y() * kRadiansPerDegree;
    const double f = crs.body().flattening, e2 = f * (2 - f), sine = std::sin(latitude);
    x_scale = std::cos(latitude), y_scale = (1 - e2) / (1 - e2 * sine * sine);
  }
  const auto along = [&](const Eigen::Vector2d& step) {
    const auto at = [&](double sign) {
      const Eigen::Vector2d there = position + sign * step;
      return frame.crs_from_map_frame({{there.x(), there.y(), 0}}).xyz;
    };
    const Eigen::Vector3d to = at(1), from = at(-1);
    const double dx =
        crs.kind() == CrsKind::geographic ? std::remainder(to.x() - from.x(), 360.0) : to.x() - from.x();
    return Eigen::Vector2d(x_scale * dx, y_scale * (to.y() - from.y()));
  };
  const Eigen::Vector2d u = along({kStep, 0}), v = along({0, kStep});
  return std::atan2(u.y() - v.x(), u.x() + v.y());  // polar decomposition
}

}  // namespace waymark::inline geo
