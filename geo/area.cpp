// SPDX-License-Identifier: Apache-2.0
#include "geo/area.hpp"

#include <limits>
#include <utility>

namespace waymark::inline geo {
namespace {

// Counts crossings of the ray towards +x.
bool is_inside(const std::vector<Area::Ring>& rings, double x, double y) {
  bool inside = false;
  for (const Area::Ring& ring : rings)
    for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) {
      const Eigen::Vector2d &a = ring[last], &b = ring[i];
      if ((a.y() > y) == (b.y() > y)) continue;
      if (x < a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y())) inside = !inside;
    }
  return inside;
}

}  // namespace

Area::Area(std::vector<std::vector<Ring>> polygons, bool degrees) : degrees_(degrees) {
  for (auto& rings : polygons) {
    Part part{.rings = std::move(rings),
              .low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()),
              .high = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity())};
    for (const Ring& ring : part.rings)
      for (const Eigen::Vector2d& corner : ring) {
        part.low = part.low.cwiseMin(corner);
        part.high = part.high.cwiseMax(corner);
      }
    parts_.push_back(std::move(part));
  }
}

bool Area::contains(double x, double y) const {
  for (const double turn : {0.0, -360.0, 360.0}) {
    if (turn != 0 && !degrees_) break;
    const double at = x + turn;
    for (const Part& part : parts_)
      if (at >= part.low.x() && at <= part.high.x() && y >= part.low.y() && y <= part.high.y() &&
          is_inside(part.rings, at, y))
        return true;
  }
  return false;
}

}  // namespace waymark::inline geo
