// SPDX-License-Identifier: Apache-2.0
#include "planning/route_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>

namespace waymark::test {
namespace {

using namespace planning;
using localization::LandmarkGrid;
using localization::MapLandmark;

MapLandmark landmark(double x, double y, double sd = 0.1) {
  MapLandmark l;
  l.at = {x, y};
  l.covariance = Eigen::Matrix2d::Identity() * sd * sd;
  return l;
}

LandmarkSensing sensing(double range, double view = 360) {
  return {.coverage = {.range = range, .view = view, .range_sd = 0.1, .bearing_sd = 0.6}};
}

RouteProblem problem_of(std::int64_t columns, std::int64_t rows, const LandmarkGrid& map,
                        const LandmarkSensing& sensor, double cell = 2) {
  RouteProblem problem;
  const RouteCells cells{.cell = cell, .columns = columns, .rows = rows};
  problem.passable.assign(static_cast<std::size_t>(cells.count()), 1);
  problem.field = make_information_field(cells, problem.passable, map, sensor);
  problem.to = cells.count() - 1;
  problem.start = {0.01, 0, 0.01, 0, 0, 0.001};
  return problem;
}

/// The cheapest of all paths that visit no cell twice.
double by_enumeration(const RouteProblem& problem, double max_sd) {
  const RouteCells& cells = problem.field.cells;
  double best = std::numeric_limits<double>::infinity();
  std::vector<char> visited(static_cast<std::size_t>(cells.count()), 0);
  const std::function<void(std::int64_t, int, const Symmetric3&, double)> visit =
      [&](std::int64_t cell, int heading, const Symmetric3& p, double length) {
        if (length >= best) return;
        if (cell == problem.to) {
          best = length;
          return;
        }
        visited[static_cast<std::size_t>(cell)] = 1;
        for (int h = 0; h < kHeadings; ++h) {
          const double angle = h * std::numbers::pi / 4;
          const std::int64_t c = cell % cells.columns + std::lround(std::cos(angle)),
                             r = cell / cells.columns + std::lround(std::sin(angle));
          if (c < 0 || r < 0 || c >= cells.columns || r >= cells.rows) continue;
          const std::int64_t next = r * cells.columns + c;
          if (visited[static_cast<std::size_t>(next)]) continue;
          const double turn =
              heading < 0 ? 0 : std::abs(localization::wrap_angle((h - heading) * std::numbers::pi / 4));
          const Symmetric3 after = step_belief(problem, p, next, h, turn);
          if (position_sd(after) > max_sd) continue;
          visit(next, h, after, length + cells.cell * (h % 2 ? std::numbers::sqrt2 : 1));
        }
        visited[static_cast<std::size_t>(cell)] = 0;
      };
  visit(problem.from, -1, problem.start, 0);
  return best;
}

TEST(RouteSearch, ExactSearchEqualsEnumeration) {
  int limited = 0, infeasible = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<MapLandmark> marks;
    for (int i = 0; i < 2; ++i) marks.push_back(landmark(24 * uniform(random), 24 * uniform(random)));
    const LandmarkGrid map(marks);
    const RouteProblem problem = problem_of(4, 4, map, sensing(7, seed % 2 ? 90 : 360), 8);
    const double max_sd = 0.75 + 0.35 * uniform(random);
    const double expected = by_enumeration(problem, max_sd);
    const auto route = search_by_sigma(problem, {.max_sd = max_sd, .labels = 100000, .tolerance = 0});
    ASSERT_EQ(route.has_value(), std::isfinite(expected)) << "seed " << seed;
    infeasible += !route;
    if (!route) continue;
    // A search may visit a cell twice and be shorter for it; without that both are equal.
    std::set<std::int64_t> cells;
    for (const RouteNode& node : route->nodes) cells.insert(node.cell);
    const bool simple = cells.size() == route->nodes.size();
    EXPECT_TRUE(!simple || std::abs(route->length - expected) < 1e-9) << "seed " << seed;
    EXPECT_LE(route->length, expected + 1e-9) << "seed " << seed;
    limited += expected > 3 * 8 * std::numbers::sqrt2 + 1e-9;
    // What the search finds, the relaxed test does not exclude.
    EXPECT_TRUE(std::isfinite(relaxed_sd(problem, max_sd)[static_cast<std::size_t>(problem.to)]));
    EXPECT_LE(relaxed_sd(problem, max_sd)[static_cast<std::size_t>(problem.to)],
              position_sd(route->nodes.back().covariance));
  }
  EXPECT_GT(limited, 3);  // the cases are not all trivial
  EXPECT_GT(infeasible, 3);
}

/// Relaxes every step until nothing changes (Bellman and Ford).
std::vector<double> by_relaxation(const RouteCells& cells, const std::vector<char>& passable,
                                  std::int64_t to) {
  const auto is_open = [&](std::int64_t c, std::int64_t r) {
    return c >= 0 && r >= 0 && c < cells.columns && r < cells.rows &&
           passable[static_cast<std::size_t>(r * cells.columns + c)];
  };
  std::vector<double> distance(static_cast<std::size_t>(cells.count()),
                               std::numeric_limits<double>::infinity());
  distance[static_cast<std::size_t>(to)] = 0;
  for (bool changes = true; changes;) {
    changes = false;
    for (std::int64_t i = 0; i < cells.count(); ++i)
      for (int dc = -1; dc <= 1; ++dc)
        for (int dr = -1; dr <= 1; ++dr) {
          const std::int64_t c = i % cells.columns, r = i / cells.columns;
          if ((!dc && !dr) || !is_open(c + dc, r + dr) || !is_open(c + dc, r) || !is_open(c, r + dr))
            continue;
          const double there =
              distance[static_cast<std::size_t>(i)] + cells.cell * (dc && dr ? std::numbers::sqrt2 : 1);
          double& best = distance[static_cast<std::size_t>((r + dr) * cells.columns + c + dc)];
          if (there < best) best = there, changes = true;
        }
  }
  return distance;
}

TEST(RouteSearch, DistancesEqualRelaxationToTheLastBit) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int round = 0; round < 60; ++round) {
    const RouteCells cells{
        .cell = 0.1 + 3 * uniform(random), .columns = 1 + round % 23, .rows = 1 + round * 7 % 31};
    std::vector<char> passable(static_cast<std::size_t>(cells.count()));
    const double open = 0.5 + 0.5 * uniform(random);
    for (char& p : passable) p = uniform(random) < open;
    const auto to = static_cast<std::int64_t>(uniform(random) * static_cast<double>(cells.count()));
    passable[static_cast<std::size_t>(to)] = 1;
    EXPECT_EQ(distances_to(cells, passable, to), by_relaxation(cells, passable, to)) << "round " << round;
  }
}

/// Returns 25 landmarks in a square of 80 m.
LandmarkGrid scattered_landmarks(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<MapLandmark> marks;
  for (int i = 0; i < 25; ++i) marks.push_back(landmark(80 * uniform(random), 80 * uniform(random)));
  return LandmarkGrid(marks);
}

TEST(RouteSearch, GivenDistancesChangeNothing) {
  const LandmarkGrid map = scattered_landmarks(5);
  RouteProblem problem = problem_of(41, 41, map, sensing(12));
  const auto own = search_by_sigma(problem, {.max_sd = 1.2});
  problem.to_go = distances_to(problem.field.cells, problem.passable, problem.to);
  const auto given = search_by_sigma(problem, {.max_sd = 1.2});
  ASSERT_EQ(own.has_value(), given.has_value());
  if (!own) return;
  EXPECT_EQ(own->length, given->length);
  EXPECT_EQ(own->worst_sd, given->worst_sd);
  EXPECT_EQ(relaxed_sd(problem, 1.2), relaxed_sd(problem, 1.2, max_rate(problem.field)));
}

TEST(RouteSearch, MoreLabelsAreNeverLongerAndTheLimitIsKept) {
  const LandmarkGrid map = scattered_landmarks(4);
  const RouteProblem problem = problem_of(41, 41, map, sensing(12));
  const auto shortest = search_by_sigma(problem, {});
  ASSERT_TRUE(shortest);
  EXPECT_NEAR(shortest->length, 80 * std::numbers::sqrt2, 1e-9);
  const double limit = 0.8 * shortest->worst_sd;
  double before = std::numeric_limits<double>::infinity();
  for (const int labels : {1, 4, 16}) {
    const auto route = search_by_sigma(problem, {.max_sd = limit, .labels = labels, .tolerance = 0.02});
    ASSERT_TRUE(route) << labels;
    EXPECT_LE(route->worst_sd, limit);
    EXPECT_LE(route->length, before + 1e-9);
    EXPECT_GE(route->length, shortest->length);
    before = route->length;
  }
}

TEST(RouteSearch, OneLandmarkAcrossTheWayBoundsOnlyTheDistanceToIt) {
  const LandmarkGrid map({landmark(0, 10)});
  const LandmarkSensing sensor{.coverage = {.range = 20, .range_sd = 0.1, .bearing_sd = 1e6}};
  const Information seen = information_at({0, 0, 0}, map, sensor);
  EXPECT_GT(seen.rate.yy, 1);
  EXPECT_NEAR(seen.rate.xx, 0, 1e-6);
  EXPECT_EQ(seen.landmarks, 1);
}

TEST(RouteSearch, ViewAndRangeBoundWhatIsSeen) {
  const LandmarkGrid map({landmark(10, 0), landmark(0, 10), landmark(-10, 0), landmark(30, 0)});
  EXPECT_EQ(information_at({0, 0, 0}, map, sensing(20)).landmarks, 3);
  EXPECT_EQ(information_at({0, 0, 0}, map, sensing(20, 90)).landmarks, 1);
  EXPECT_EQ(information_at({0, 0, std::numbers::pi / 4}, map, sensing(20, 100)).landmarks, 2);
}

TEST(RouteSearch, LandmarksAreKeptInRangeAtTheLeastDetour) {
  // Landmarks along the southern edge, within 8 m: the way from corner to corner keeps there as long as it
  // can.
  std::vector<MapLandmark> marks;
  for (int i = 0; i <= 40; i += 2) marks.push_back(landmark(i, -4));
  const LandmarkGrid map(marks);
  RouteProblem problem = problem_of(21, 11, map, sensing(8));
  problem.to = 20;  // the other southern corner
  const auto route = search_by_landmarks(problem, 2, false);
  ASSERT_TRUE(route);
  EXPECT_EQ(route->outside, 0);
  EXPECT_DOUBLE_EQ(route->length, 40);
  problem.to = problem.field.cells.count() - 1;  // the north-eastern corner, 20 m away from them
  const auto leaving = search_by_landmarks(problem, 2, false);
  ASSERT_TRUE(leaving);
  // Two landmarks are within 8 m up to y = 2; from there eight steps of 2 m straight north, less the first.
  EXPECT_NEAR(leaving->outside, 16, 2.01);
}

TEST(RouteSearch, NoWayIsNoRoute) {
  const LandmarkGrid map({landmark(0, 0)});
  RouteProblem problem = problem_of(5, 5, map, sensing(8));
  for (std::int64_t i = 10; i < 15; ++i) problem.passable[static_cast<std::size_t>(i)] = 0;
  EXPECT_FALSE(search_by_sigma(problem, {}));
  EXPECT_FALSE(search_by_landmarks(problem, 1, false));
}

}  // namespace
}  // namespace waymark::test
