// SPDX-License-Identifier: Apache-2.0
#include "planning/route_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>

namespace waymark::test {
namespace {

using namespace planning;

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

TEST(RouteProblem, DistancesEqualRelaxationToTheLastBit) {
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
    const std::vector<double> one = distances_to(cells, passable, to);
    EXPECT_EQ(one, by_relaxation(cells, passable, to)) << "round " << round;
    // The nearest of several goals.
    const std::int64_t other = cells.count() / 2;
    passable[static_cast<std::size_t>(other)] = 1;
    std::vector<double> nearest = by_relaxation(cells, passable, to);
    const std::vector<double> from_other = by_relaxation(cells, passable, other);
    for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = std::min(nearest[i], from_other[i]);
    EXPECT_EQ(distances_to(cells, passable, std::vector{to, other}), nearest) << "round " << round;
  }
}

TEST(RouteProblem, MovesAreTheNeighbours) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int round = 0; round < 60; ++round) {
    const RouteCells cells{.cell = 0.3, .columns = 1 + round % 7, .rows = 1 + round * 5 % 11};
    std::vector<char> passable(slot(cells.count()));
    for (char& p : passable) p = uniform(random) < 0.7 ? 1 : 0;
    const Moves moves(cells, passable);
    for (std::int64_t cell = 0; cell < cells.count(); ++cell)
      for (int h = 0; h < kHeadings; ++h) {
        const std::int64_t next = neighbour(cells, passable, cell, h);
        ASSERT_EQ(moves.from(cell) >> h & 1U, next >= 0 ? 1U : 0U) << "round " << round;
        EXPECT_TRUE(next < 0 || moves.to(cell, h) == next);
        EXPECT_EQ(moves.length(h), step_length(cells, h));
      }
  }
}

TEST(RouteProblem, TurnsAreTheShorterWayRound) {
  EXPECT_EQ(turn_between(3, 3), 0);
  EXPECT_DOUBLE_EQ(turn_between(7, 1), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(turn_between(0, 4), std::numbers::pi);
}

}  // namespace
}  // namespace waymark::test
