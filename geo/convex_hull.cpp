// SPDX-License-Identifier: Apache-2.0
#include "geo/convex_hull.hpp"

#include <algorithm>

namespace waymark::inline geo {

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  using Place = Eigen::Vector2d;
  std::ranges::sort(
      points, [](const Place& a, const Place& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  const auto turns_left = [](const Place& a, const Place& b, const Place& c) {
    const Place first = b - a, second = c - b;
    return first.x() * second.y() - first.y() * second.x() > 0;
  };
  std::vector<Place> hull;
  const auto extend = [&](const Place& place, std::size_t min_size) {
    while (hull.size() >= min_size && !turns_left(hull[hull.size() - 2], hull.back(), place)) hull.pop_back();
    hull.push_back(place);
  };
  for (const Place& place : points) extend(place, 2);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size(); i-- > 1;) extend(points[i - 1], lower + 1);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

}  // namespace waymark::inline geo
