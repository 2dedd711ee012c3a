// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/stand_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geo/convex_hull.hpp"

namespace waymark::pipeline {
namespace {

using Place = Eigen::Vector2d;
using Ring = std::vector<Place>;

constexpr double kNoArea = 1e-6;  // m2, and metres: rounding residue

double cross(const Place& a, const Place& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Signed; relative to the first corner, for precision at coordinates of a million metres.
double ring_area(const Ring& ring) {
  double doubled = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    doubled += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return doubled / 2;
}

bool surrounds(const Ring& ring, const Place& place) {
  bool odd = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    // Lower corner first, so that an edge gives the same result for the polygons on both sides.
    const Place *low = &ring[i], *high = &ring[(i + 1) % ring.size()];
    if (low->y() > high->y()) std::swap(low, high);
    if (!(low->y() <= place.y() && place.y() < high->y())) continue;
    const double x = low->x() + (high->x() - low->x()) * (place.y() - low->y()) / (high->y() - low->y());
    if (place.x() < x) odd = !odd;
  }
  return odd;
}

/// Nesting depth of a ring: rings at odd depth are holes.
int depth_of(const StandPolygon& stand, std::size_t index) {
  int depth = 0;
  const Ring& ring = stand.rings[index];
  if (ring.size() < 3) return 0;
  // Tests a point just inside the longest edge, since rings may share corners and edges.
  std::size_t longest = 0;
  const auto edge = [&](std::size_t k) { return Place(ring[(k + 1) % ring.size()] - ring[k]); };
  for (std::size_t k = 1; k < ring.size(); ++k)
    if (edge(k).squaredNorm() > edge(longest).squaredNorm()) longest = k;
  const Place along = edge(longest);
  const Place inwards = (ring_area(ring) > 0 ? 1 : -1) * Place(-along.y(), along.x());
  const Place middle = ring[longest] + along / 2 + 1e-6 * inwards;
  for (std::size_t i = 0; i < stand.rings.size(); ++i)
    if (i != index && surrounds(stand.rings[i], middle)) ++depth;
  return depth;
}

double distance_to_segment(const Place& a, const Place& b, const Place& place) {
  const Place along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((place - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (a + t * along - place).norm();
}

}  // namespace

double area(const StandPolygon& stand) {
  double sum = 0;
  for (std::size_t i = 0; i < stand.rings.size(); ++i) {
    const double part = std::abs(ring_area(stand.rings[i]));
    sum += depth_of(stand, i) % 2 == 0 ? part : -part;
  }
  return sum;
}

Eigen::AlignedBox2d bounds(const StandPolygon& stand) {
  Eigen::AlignedBox2d box;
  for (const Ring& ring : stand.rings)
    for (const Place& corner : ring) box.extend(corner);
  return box;
}

bool inside(const StandPolygon& stand, const Place& place) {
  bool odd = false;
  for (const Ring& ring : stand.rings) odd = odd != surrounds(ring, place);
  return odd;
}

double distance_to_edge(const StandPolygon& stand, const Place& place) {
  double min_distance = std::numeric_limits<double>::infinity();
  for (const Ring& ring : stand.rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      min_distance = std::min(min_distance, distance_to_segment(ring[i], ring[(i + 1) % ring.size()], place));
  return min_distance;
}

StandPolygon clip_polygon(const StandPolygon& stand, const Eigen::AlignedBox2d& box) {
  StandPolygon part;
  for (Ring ring : stand.rings) {
    for (int axis = 0; axis < 2; ++axis)
      for (const double side : {1.0, -1.0}) {
        const double limit = side > 0 ? box.max()[axis] : box.min()[axis];
        const auto beyond = [&](const Place& at) { return side * (at[axis] - limit); };
        Ring kept;
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Place &a = ring[i], &b = ring[(i + 1) % ring.size()];
          if (beyond(a) <= 0) kept.push_back(a);
          if ((beyond(a) < 0 && beyond(b) > 0) || (beyond(a) > 0 && beyond(b) < 0))
            kept.push_back(a + (b - a) * (beyond(a) / (beyond(a) - beyond(b))));
        }
        ring = std::move(kept);
      }
    if (!(ring.size() >= 3 && std::abs(ring_area(ring)) > kNoArea)) continue;
    // A hole that equals its outer ring removes both.
    const auto around = std::ranges::find_if(part.rings, [&](const Ring& other) {
      return std::abs(std::abs(ring_area(other)) - std::abs(ring_area(ring))) < kNoArea &&
             std::ranges::all_of(ring,
                                 [&](const Place& at) { return distance_to_edge({{other}}, at) < kNoArea; });
    });
    if (around != part.rings.end())
      part.rings.erase(around);
    else
      part.rings.push_back(std::move(ring));
  }
  return part;
}

StandPolygon estimate_sampled_area(const std::vector<Place>& trees) {
  Ring hull = trees.size() < 4 ? Ring{} : convex_hull(trees);
  if (hull.size() < 3 || !(ring_area(hull) > 0)) return {};
  const double n = static_cast<double>(trees.size()), m = static_cast<double>(hull.size());
  Place centroid = Place::Zero();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Place a = hull[i] - hull[0], b = hull[(i + 1) % hull.size()] - hull[0];
    centroid += (a + b) * cross(a, b) / 6;
  }
  centroid = hull[0] + centroid / ring_area(hull);
  const double factor = 1 / std::sqrt(std::max(1 - m / n, 0.25));
  for (Place& corner : hull) corner = centroid + factor * (corner - centroid);
  return {{hull}};
}

}  // namespace waymark::pipeline
