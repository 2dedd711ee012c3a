// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <map>
#include <vector>

#include "pipeline/buildings/find_buildings.hpp"
#include "tests/pipeline/buildings/made_town.hpp"
namespace waymark::test {
using namespace pipeline;

inline bool in_ring(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

/// Intersection over union of two outlines, on cells of 0.1 m.
inline double overlap(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  Eigen::Vector2d low = a[0], high = a[0];
  for (const auto* ring : {&a, &b})
    for (const Eigen::Vector2d& p : *ring) low = low.cwiseMin(p), high = high.cwiseMax(p);
  double both = 0, any = 0;
  for (double y = low.y() + 0.05; y < high.y(); y += 0.1)
    for (double x = low.x() + 0.05; x < high.x(); x += 0.1) {
      const bool in_a = in_ring(a, {x, y}), in_b = in_ring(b, {x, y});
      both += in_a && in_b, any += in_a || in_b;
    }
  return any > 0 ? both / any : 0;
}

struct TownScore {
  int truth = 0, found = 0, matched = 0;
  int corners = 0, corners_found = 0, false_corners = 0;
  double iou = 0, corner2 = 0, height = 0, height2 = 0, nees = 0, area = 0;
  std::map<std::string, int> kinds;

  double recall() const { return truth ? double(matched) / truth : 1; }
  double precision() const { return found ? double(matched) / found : 1; }
  double mean_iou() const { return matched ? iou / matched : 0; }
  double corner_rms() const { return corners_found ? std::sqrt(corner2 / corners_found) : 0; }
  double height_bias() const { return matched ? height / matched : 0; }
  double height_rms() const { return matched ? std::sqrt(height2 / matched) : 0; }
};

/// Adds the buildings of a town to a score. A building is right if it overlaps a house by half of their
/// union, a corner if it lies within 1.5 m of one of the house's.
inline void score(const MadeTown& town, const TownCanopy& canopy, const std::vector<DetectedBuilding>& found,
                  TownScore& into) {
  into.truth += int(town.houses.size()), into.found += int(found.size());
  for (const DetectedBuilding& b : found) {
    std::vector<Eigen::Vector2d> ring;
    for (const Eigen::Vector2d& v : b.outline.outer.vertices) ring.push_back(canopy.in_town(v));
    const House* best = nullptr;
    double iou = 0.5;
    for (const House& h : town.houses)
      if ((h.at - ring[0]).norm() < 40)
        if (const double o = overlap(ring, h.outline()); o > iou) iou = o, best = &h;
    if (!best) continue;
    ++into.matched;
    into.iou += iou;
    into.area += b.area / ring_area(best->outline()) - 1;
    const double height = b.height + b.ground - town.foot(*best) - best->height();
    into.height += height, into.height2 += height * height;
    ++into.kinds[to_string(b.roof)];
    for (const Eigen::Vector2d& corner : best->outline()) {
      ++into.corners;
      double nearest = 1.5;
      std::size_t at = 0;
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (const double d = (ring[i] - corner).norm(); d < nearest) nearest = d, at = i;
      if (nearest == 1.5) continue;
      ++into.corners_found;
      into.corner2 += nearest * nearest;
      const double sd =
          std::hypot(b.outline.outer.sd[at], b.outline.outer.sd[(at + ring.size() - 1) % ring.size()]);
      into.nees += nearest * nearest / (sd * sd);
    }
    for (const Eigen::Vector2d& v : ring) {
      double nearest = 1.5;
      for (const Eigen::Vector2d& corner : best->outline()) nearest = std::min(nearest, (v - corner).norm());
      into.false_corners += nearest == 1.5;
    }
  }
}

}  // namespace waymark::test
