// SPDX-License-Identifier: Apache-2.0
#include "geodb/rtree/search_windows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.hpp"

namespace waymark::geodb {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();
constexpr double kTurn = 360;

/// Returns the longitudes from `west` to `west + width` degrees, shifted by -360, 0 and 360 degrees.
SearchWindows repeated(double west, double width, double south, double north) {
  if (!(width < kTurn)) return {{-kEverywhere, south, kEverywhere, north}};
  SearchWindows windows;
  const double first = west - kTurn * std::floor((west + kTurn / 2) / kTurn);  // [-180, 180)
  for (const double turn : {-kTurn, 0.0, kTurn})
    windows.push_back({first + turn, south, first + turn + width, north});
  return windows;
}

}  // namespace

SearchWindows whole_plane() {
  return {{-kEverywhere, -kEverywhere, kEverywhere, kEverywhere}};
}

SearchWindows search_windows(const Crs& crs, const MapQuery::Box& box) {
  if (crs.kind() != CrsKind::geographic) return {box};
  const double width = box.max_x - box.min_x;
  return repeated(box.min_x, width < 0 ? width + kTurn : width, box.min_y, box.max_y);
}

SearchWindows search_windows(const Crs& crs, const MapQuery::Near& near) {
  if (crs.kind() != CrsKind::geographic) {
    const double radius = near.radius.value / crs.metres_per_unit();
    return {{near.x - radius, near.y - radius, near.x + radius, near.y + radius}};
  }
  // A path of length r stays between two parallels: a radian of latitude is shortest at the equator, b^2 / a.
  // Between them a radian of longitude is at least a cos(latitude) of the outer parallel. So the window
  // contains all points within r. 1e-9 degrees (0.1 mm) cover rounding.
  const Body& body = crs.body();
  const double shortest = std::pow(body.polar_radius(), 2) / body.equatorial_radius;
  const double up = to_degrees(Radians{near.radius.value / shortest}).value + 1e-9;
  const double south = near.y - up, north = near.y + up;
  const double outer = to_radians(Degrees{std::max(std::abs(south), std::abs(north))}).value;
  if (outer >= to_radians(Degrees{90}).value) return {{-kEverywhere, south, kEverywhere, north}};
  const double around =
      to_degrees(Radians{near.radius.value / (body.equatorial_radius * std::cos(outer))}).value + 1e-9;
  return repeated(near.x - around, 2 * around, south, north);
}

bool contains(const SearchWindows& windows, double x, double y) {
  return std::ranges::any_of(windows, [&](const MapQuery::Box& w) {
    return w.min_x <= x && x <= w.max_x && w.min_y <= y && y <= w.max_y;
  });
}

MapDistance::MapDistance(const Crs& crs) : metres_per_unit_(crs.metres_per_unit()) {
  if (crs.kind() == CrsKind::geographic) geodesic_.emplace(crs.body());
}

double MapDistance::operator()(double x0, double y0, double x1, double y1) const {
  if (geodesic_) return geodesic_->distance({x0, y0}, {x1, y1});
  return std::hypot(x1 - x0, y1 - y0) * metres_per_unit_;
}

}  // namespace waymark::geodb
