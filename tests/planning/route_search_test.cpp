// SPDX-License-Identifier: Apache-2.0
#include "planning/route_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "planning/sd_bounds.hpp"
#include "tests/support/small_routes.hpp"

namespace waymark::test {
namespace {

using namespace planning;
using localization::LandmarkGrid;
using localization::MapLandmark;

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

TEST(RouteSearch, ExactWeightedSearchEqualsEnumeration) {
  int longer = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<MapLandmark> marks;
    for (int i = 0; i < 2; ++i) marks.push_back(landmark(24 * uniform(random), 24 * uniform(random)));
    const RouteProblem problem = problem_of(4, 4, LandmarkGrid(marks), sensing(7, seed % 2 ? 90 : 360), 8);
    const double weight = std::pow(10, 2 * uniform(random));
    const auto route = search_by_sigma(problem, {.weight = weight, .labels = 100000, .tolerance = 0});
    ASSERT_TRUE(route) << "seed " << seed;
    // A search may visit a cell twice and be cheaper for it; without that both are equal.
    std::set<std::int64_t> cells;
    for (const RouteNode& node : route->nodes) cells.insert(node.cell);
    const double expected = by_enumeration(problem, 1e9, weight);
    EXPECT_LE(route->cost, expected * (1 + 1e-12)) << "seed " << seed;
    const bool simple = cells.size() == route->nodes.size();
    EXPECT_TRUE(!simple || std::abs(route->cost - expected) < 1e-9 * expected) << "seed " << seed;
    longer += route->length > 3 * 8 * std::numbers::sqrt2 + 1e-9;
  }
  EXPECT_GT(longer, 3);  // the cases are not all trivial
}

/// Keeps the first label of each cell and heading that is taken from one ordered list, without bounds.
double cost_with_one_label(const RouteProblem& problem, double weight) {
  struct Open {
    double cost;
    int heading;
    Symmetric3 covariance;
    bool is_start;
  };
  std::multimap<double, std::pair<std::int64_t, Open>> open;
  const std::vector<double> to_go =
      cost_to_go(problem, weight, relaxed_sd(problem, std::numeric_limits<double>::infinity()));
  for (int h = 0; h < kHeadings; ++h)
    open.emplace(to_go[0], std::pair(problem.from, Open{0, h, problem.start, true}));
  std::set<std::pair<std::int64_t, int>> closed;
  while (!open.empty()) {
    const auto [cell, label] = open.begin()->second;
    open.erase(open.begin());
    if (!closed.emplace(cell, label.heading).second) continue;
    if (cell == problem.to) return label.cost;
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(problem.field.cells, problem.passable, cell, h);
      if (next < 0 || (label.is_start && h != label.heading)) continue;
      const Symmetric3 p = step_belief(problem, label.covariance, next, h, turn_between(label.heading, h));
      const double cost = label.cost + step_length(problem.field.cells, h) * (1 + weight * position_sd(p));
      open.emplace(cost + to_go[slot(next)], std::pair(next, Open{cost, h, p, false}));
    }
  }
  return std::numeric_limits<double>::infinity();
}

TEST(RouteSearch, OneLabelIsTheFirstOfItsCellAndHeading) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const LandmarkGrid map = scattered_landmarks(seed);
    const RouteProblem problem = problem_of(41, 41, map, sensing(12, seed % 2 ? 360 : 120));
    const double weight = seed;
    const auto route = search_by_sigma(problem, {.weight = weight, .labels = 1});
    ASSERT_TRUE(route);
    EXPECT_EQ(route->cost, cost_with_one_label(problem, weight)) << "seed " << seed;
  }
}

/// The same search with a limit by one ordered list, which compares each label with all that were closed.
std::optional<double> length_within(const RouteProblem& problem, const SigmaSearch& wanted) {
  struct Open {
    double cost;
    std::int64_t cell;
    int heading;
    Symmetric3 covariance;
    bool is_start;
  };
  std::multimap<double, Open> open;  // equal keys: in the order of insertion
  std::map<std::int64_t, std::vector<Open>> closed;
  const std::vector<double> to_go = distances_to(problem.field.cells, problem.passable, problem.to);
  const double scale = (1 + wanted.tolerance) * (1 + wanted.tolerance);
  const auto is_dominated = [&](const Open& label) {
    int kept = 0;
    for (const Open& other : closed[label.cell]) {
      kept += other.heading == label.heading;
      Symmetric3 earlier = other.covariance;
      earlier.tt += problem.noise.yaw_per_radian * turn_between(other.heading, label.heading);
      if (other.cost <= label.cost &&
          (earlier == label.covariance || exceeds(label.covariance, earlier, scale)))
        return true;
    }
    return kept >= wanted.labels;
  };
  for (int h = 0; h < kHeadings; ++h)
    open.emplace(to_go[slot(problem.from)], Open{0, problem.from, h, problem.start, true});
  while (!open.empty()) {
    const Open label = open.begin()->second;
    open.erase(open.begin());
    if (is_dominated(label)) continue;
    if (label.cell == problem.to) return label.cost;
    closed[label.cell].push_back(label);
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(problem.field.cells, problem.passable, label.cell, h);
      if (next < 0 || (label.is_start && h != label.heading)) continue;
      const Symmetric3 p = step_belief(problem, label.covariance, next, h, turn_between(label.heading, h));
      if (!(position_sd(p) <= wanted.max_sd)) continue;
      const double cost = label.cost + step_length(problem.field.cells, h);
      open.emplace(cost + to_go[slot(next)], Open{cost, next, h, p, false});
    }
  }
  return {};
}

TEST(RouteSearch, ALimitedSearchEqualsOneOrderedListToTheLastBit) {
  int refused = 0, longer = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    RouteProblem problem = problem_of(31, 31, scattered_landmarks(seed), sensing(8, seed % 2 ? 360 : 120));
    const double free = search_by_sigma(problem, {})->worst_sd;
    for (const int labels : {1, 3})
      for (const double part : {0.9, 0.7, 0.5}) {
        const SigmaSearch wanted{.max_sd = part * free, .labels = labels};
        const auto expected = length_within(problem, wanted);
        const auto route = search_by_sigma(problem, wanted);
        ASSERT_EQ(route.has_value(), expected.has_value()) << "seed " << seed;
        refused += !route;
        if (!route) continue;
        EXPECT_EQ(route->length, *expected) << "seed " << seed;
        longer += route->length > 60 * std::numbers::sqrt2 + 1e-9;
      }
  }
  EXPECT_GT(refused, 3);  // the cases are not all trivial
  EXPECT_GT(longer, 3);
}

TEST(RouteSearch, MaxCostDropsOnlyDearerRoutes) {
  const LandmarkGrid map = scattered_landmarks(6);
  const RouteProblem problem = problem_of(41, 41, map, sensing(12));
  const auto free = search_by_sigma(problem, {.weight = 3});
  ASSERT_TRUE(free);
  const auto bounded = search_by_sigma(problem, {.weight = 3, .max_cost = free->cost * (1 + 1e-9)});
  ASSERT_TRUE(bounded);
  EXPECT_EQ(bounded->cost, free->cost);
  EXPECT_FALSE(search_by_sigma(problem, {.weight = 3, .max_cost = free->cost * 0.99}));
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
  const auto weighted = search_by_sigma(problem, {.weight = 2});
  problem.min_sd = relaxed_sd(problem, std::numeric_limits<double>::infinity());
  EXPECT_EQ(weighted->cost, search_by_sigma(problem, {.weight = 2})->cost);
  EXPECT_EQ(relaxed_sd(problem, 1.2), relaxed_sd(problem, 1.2, {problem.noise, max_rate(problem.field)}));
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

TEST(RouteSearch, ReportsWhatIsDoneAndEndsWhereItIsAsked) {
  struct Stop {};
  RouteProblem problem = problem_of(120, 120, scattered_landmarks(5), sensing(20));
  const auto by_sigma = [&] { return search_by_sigma(problem, {.weight = 3}); };
  const auto by_landmarks = [&] { return search_by_landmarks(problem, 100, false); };
  for (const std::function<std::optional<Route>()>& search : {std::function(by_sigma), {by_landmarks}}) {
    std::vector<double> done;
    problem.advanced = [&](double part) { done.push_back(part); };
    ASSERT_TRUE(search());
    ASSERT_GE(done.size(), 2);
    EXPECT_TRUE(std::ranges::is_sorted(done));
    EXPECT_GT(done.front(), 0);
    EXPECT_LE(done.back(), 1);
    problem.advanced = [](double) { throw Stop(); };
    EXPECT_THROW(search(), Stop);
  }
}

}  // namespace
}  // namespace waymark::test
