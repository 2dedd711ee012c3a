// SPDX-License-Identifier: Apache-2.0
#include "planning/sd_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/small_routes.hpp"

namespace waymark::test {
namespace {

using namespace planning;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Random drives among few landmarks, with long ways between them and back over the same ground.
TEST(SdBounds, NoDriveIsBelow) {
  double closest = kNoLimit;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<localization::MapLandmark> marks;
    for (unsigned i = 0; i < seed % 4; ++i)
      marks.push_back(landmark(60 * uniform(random), 60 * uniform(random)));
    RouteProblem problem =
        problem_of(31, 31, localization::LandmarkGrid(marks), sensing(8, seed % 2 ? 90 : 360));
    problem.from = static_cast<std::int64_t>(uniform(random) * 961);
    problem.noise.along_per_metre = 0.03 * uniform(random),
    problem.noise.across_per_metre = 0.03 * uniform(random);
    const std::vector<double> bound = relaxed_sd(problem, kNoLimit);
    for (int drive = 0; drive < 20; ++drive) {
      std::int64_t cell = problem.from;
      Symmetric3 p = problem.start;
      int heading = static_cast<int>(8 * uniform(random));
      double worst = position_sd(p);
      for (int step = 0; step < 60; ++step) {
        const int next_heading = uniform(random) < 0.8 ? heading : static_cast<int>(8 * uniform(random));
        const std::int64_t next = neighbour(problem.field.cells, problem.passable, cell, next_heading);
        if (next < 0) continue;
        p = step_belief(problem, p, next, next_heading, turn_between(heading, next_heading));
        cell = next, heading = next_heading;
        ASSERT_GE(position_sd(p), bound[slot(cell)] * (1 - 1e-9)) << "seed " << seed << " step " << step;
        closest = std::min(closest, position_sd(p) / bound[slot(cell)]);
        worst = std::max(worst, position_sd(p));
        // The drive keeps a limit, so the bound under that limit reaches its cells.
        if (step % 20 != 19) continue;
        ASSERT_TRUE(std::isfinite(relaxed_sd(problem, worst * (1 + 1e-9))[slot(cell)]));
      }
    }
  }
  EXPECT_LT(closest, 1.2);
}

/// Relaxes every step until nothing changes, as the bound is defined.
std::vector<double> sd_by_relaxation(const RouteProblem& problem, double max_sd) {
  const RouteCells& cells = problem.field.cells;
  const std::vector<double> rate = max_rate(problem.field);
  std::vector<std::int64_t> known{problem.from};
  for (std::int64_t i = 0; i < cells.count(); ++i)
    if (rate[slot(i)] > 0) known.push_back(i);
  const auto& noise = problem.noise;
  const double q = std::min(noise.along_per_metre, noise.across_per_metre);
  std::vector<double> far = distances_to(cells, std::vector<char>(slot(cells.count()), 1), known);
  for (double& d : far) d *= 0.92387953, d = q * d + noise.yaw_per_metre * d * d * d / 3;
  std::vector<double> variance(slot(cells.count()), kNoLimit);
  variance[slot(problem.from)] = problem.start.xx;
  for (bool changes = true; changes;) {
    changes = false;
    for (std::int64_t i = 0; i < cells.count(); ++i)
      for (int h = 0; h < kHeadings; ++h) {
        const std::int64_t next = neighbour(cells, problem.passable, i, h);
        if (next < 0 || far[slot(next)] > max_sd * max_sd || !std::isfinite(variance[slot(i)])) continue;
        const double length = step_length(cells, h);
        const double v = 1 / (1 / (variance[slot(i)] + q * length) + rate[slot(next)] * length);
        if (v <= max_sd * max_sd && v < variance[slot(next)]) variance[slot(next)] = v, changes = true;
      }
  }
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = std::sqrt(std::max(variance[i], far[i]));
  return variance;
}

TEST(SdBounds, EqualRelaxation) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    RouteProblem problem = problem_of(31, 27, scattered_landmarks(seed), sensing(5, seed % 2 ? 90 : 360));
    for (char& p : problem.passable) p = uniform(random) < 0.9;
    problem.from = 400, problem.passable[400] = 1;
    problem.start = {0.04, 0, 0.04, 0, 0, 0.001};
    for (const double limit : {kNoLimit, 0.8, 0.3}) {
      const std::vector<double> fast = relaxed_sd(problem, limit), slow = sd_by_relaxation(problem, limit);
      for (std::size_t i = 0; i < fast.size(); ++i)
        ASSERT_TRUE(fast[i] == slow[i] ||
                    std::abs(fast[i] - slow[i]) < 1e-14)  // that of the start's variance
            << "seed " << seed << ": " << fast[i] << ", " << slow[i];
    }
  }
}

TEST(SdBounds, FarFromInformationItIsTheStraightDrive) {
  RouteProblem problem =
      problem_of(201, 1, localization::LandmarkGrid(std::vector<localization::MapLandmark>{}), sensing(8));
  problem.start = {1e-8, 0, 1e-8, 0, 0, 1e-8};
  Symmetric3 p = problem.start;
  for (std::int64_t i = 1; i <= 200; ++i) p = step_belief(problem, p, i, 0, 0);
  // Ways of eight directions take 8 % off the distance, a half power more off the sd.
  const double bound = relaxed_sd(problem, kNoLimit)[200];
  EXPECT_LE(bound, position_sd(p));
  EXPECT_GT(bound, 0.85 * position_sd(p));
}

TEST(SdBounds, CostToGoIsDistanceWithoutAWeight) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  RouteProblem problem = problem_of(23, 17, scattered_landmarks(2), sensing(8));
  for (char& p : problem.passable) p = uniform(random) < 0.8;
  problem.passable[slot(problem.to)] = 1;
  const std::vector<double> none(problem.passable.size(), 1.5);
  const std::vector<double> distance = distances_to(problem.field.cells, problem.passable, problem.to);
  const std::vector<double> plain = cost_to_go(problem, 0, none), weighted = cost_to_go(problem, 2, none);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (!problem.passable[i]) continue;
    EXPECT_EQ(std::isfinite(plain[i]), std::isfinite(distance[i]));
    if (!std::isfinite(plain[i])) continue;
    EXPECT_NEAR(plain[i], distance[i], 1e-9);
    EXPECT_NEAR(weighted[i], 4 * distance[i], 1e-9);
  }
}

TEST(SdBounds, PlacesOutOfReachHaveNone) {
  RouteProblem problem =
      problem_of(9, 9, localization::LandmarkGrid(std::vector<localization::MapLandmark>{}), sensing(8));
  for (std::int64_t i = 36; i < 45; ++i) problem.passable[slot(i)] = 0;
  const std::vector<double> bound = relaxed_sd(problem, kNoLimit);
  EXPECT_TRUE(std::isfinite(bound[0]));
  EXPECT_FALSE(std::isfinite(bound[80]));
  EXPECT_FALSE(std::isfinite(cost_to_go(problem, 1, bound)[0]));
}

}  // namespace
}  // namespace waymark::test
