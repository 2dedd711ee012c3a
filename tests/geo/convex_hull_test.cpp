// SPDX-License-Identifier: Apache-2.0
#include "geo/convex_hull.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"

namespace waymark::test {
namespace {

using Points = std::vector<Eigen::Vector2d>;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Slow twin: a pair of points is an edge if all others are to its left, or on it and between the two.
Points corners_by_trying_all_pairs(const Points& points) {
  Points corners;
  for (const Eigen::Vector2d& a : points)
    for (const Eigen::Vector2d& b : points) {
      if (a == b) continue;
      const bool is_edge = std::ranges::all_of(points, [&](const Eigen::Vector2d& c) {
        const double side = turn(a, b, c);
        return side > 0 || (side == 0 && (c - a).dot(b - a) >= 0 && (c - b).dot(a - b) >= 0);
      });
      if (is_edge) corners.push_back(a);
    }
  return corners;
}

bool is_less(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

Points sorted_once(Points points) {
  std::ranges::sort(points, is_less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

TEST(ConvexHull, IsThatOfTheSlowTwin) {
  Random random(9, "hulls");
  for (int round = 0; round < 200; ++round) {
    Points points;  // of a small grid, so that many are equal or on one line
    for (int n = static_cast<int>(random.uniform(2, 20)); n > 0; --n)
      points.emplace_back(std::floor(random.uniform(0, 5)), std::floor(random.uniform(0, 5)));
    const Points hull = convex_hull(points);
    EXPECT_EQ(sorted_once(hull), sorted_once(corners_by_trying_all_pairs(points)).empty()
                                     ? sorted_once(points)
                                     : sorted_once(corners_by_trying_all_pairs(points)));
    for (std::size_t i = 0; hull.size() > 2 && i < hull.size(); ++i)
      EXPECT_GT(turn(hull[i], hull[(i + 1) % hull.size()], hull[(i + 2) % hull.size()]), 0);
  }
}

TEST(ConvexHull, OfFewPointsIsThese) {
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_EQ(convex_hull({{3, 4}}).size(), 1U);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size(), 2U);
}

}  // namespace
}  // namespace waymark::test
