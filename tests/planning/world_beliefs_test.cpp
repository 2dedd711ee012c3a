// SPDX-License-Identifier: Apache-2.0
// Beliefs over worlds in which a landmark is seen each time or never.
#include "planning/world_beliefs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "planning/sd_bounds.hpp"

namespace waymark::test {
namespace {

using namespace planning;

localization::LandmarkGrid one_landmark(double confidence) {
  localization::MapLandmark l;
  l.at = {20, 5};
  l.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  l.quality = confidence;
  return localization::LandmarkGrid({l});
}

LandmarkSensing laser_sensing(double detection) {
  LandmarkSensing sensing;
  sensing.coverage.range = 15, sensing.coverage.view = 360;
  sensing.coverage.range_sd = 0.05, sensing.coverage.bearing_sd = 0.5;
  sensing.coverage.detection = detection;
  return sensing;
}

/// Variance after 30 m to the east with a landmark of some confidence.
double variance(double confidence, double detection, std::int64_t worlds = 2000) {
  const auto map = one_landmark(confidence);
  WorldBeliefs beliefs({0.01, 0, 0.01, 0, 0, 3e-4}, {}, map, worlds, 1);
  for (int i = 1; i <= 15; ++i) {
    beliefs.drive({2, 1, 0, 0});
    beliefs.see({2.0 * i, 0, 0}, 2, map, laser_sensing(detection));
  }
  return std::pow(position_sd(beliefs.mean()), 2);
}

TEST(WorldBeliefs, CertainLandmarksLeaveOneWorld) {
  EXPECT_NEAR(variance(1, 1, 1), variance(1, 1, 50), 1e-12);
  const auto map = one_landmark(1);
  DriveBelief one({0.01, 0, 0.01, 0, 0, 3e-4}, {});
  for (int i = 1; i <= 15; ++i) {
    one.drive({2, 1, 0, 0});
    Symmetric3 j;
    add(j, information_at({2.0 * i, 0, 0}, map, laser_sensing(1)).rate, 2);
    one.see(j);
  }
  EXPECT_NEAR(variance(1, 1), std::pow(position_sd(one.pose()), 2), 1e-9);
}

// 2000 draws give a share of a half within 0.03.
TEST(WorldBeliefs, AnAbsentLandmarkIsMissedAtEachSighting) {
  const double seen = variance(1, 1), never = variance(0, 1);
  ASSERT_GT(never, 4 * seen);
  EXPECT_NEAR(variance(0.5, 1), (seen + never) / 2, 0.04 * never);
}

TEST(WorldBeliefs, MissesThatRepeatAreWorseThanRandomOnesAndBetterThanAbsence) {
  const auto map = one_landmark(1);
  DriveBelief random({0.01, 0, 0.01, 0, 0, 3e-4}, {});
  for (int i = 1; i <= 15; ++i) {
    random.drive({2, 1, 0, 0});
    Symmetric3 j;
    add(j, information_at({2.0 * i, 0, 0}, map, laser_sensing(0.5)).rate, 2);
    random.see(j);
  }
  EXPECT_GT(variance(1, 0.5), std::pow(position_sd(random.pose()), 2));
  EXPECT_LT(variance(1, 0.5), variance(0.5, 1));
}

// Doubtful and rarely seen landmarks: worlds differ, and some see far more than the mean.
TEST(WorldBeliefs, MaxInformationBoundsEveryWorld) {
  const auto map = one_landmark(0.4);
  const LandmarkSensing sensing = laser_sensing(0.3);
  RouteProblem problem;
  const RouteCells cells{.cell = 2, .columns = 16, .rows = 1};
  problem.passable.assign(16, 1);
  problem.field = make_information_field(cells, problem.passable, map, sensing);
  problem.to = 15;
  problem.start = {0.01, 0, 0.01, 0, 0, 3e-4};
  Route route;
  for (std::int64_t cell = 0; cell < 16; ++cell) route.nodes.push_back({cell, 0, {}});
  const std::vector<double> max_rates = max_rate_in_any_world(cells, problem.passable, map, sensing);
  const double bound = relaxed_sd(problem, 1e6, {problem.noise, max_rates})[15];
  double least = 1e9;
  for (std::int64_t seed = 1; seed <= 40; ++seed) {
    WorldBeliefs beliefs(problem.start, {}, map, 1, seed);
    follow_route(beliefs, problem, map, sensing, route);
    least = std::min(least, position_sd(route.nodes.back().covariance));
  }
  EXPECT_GE(least, bound);
  EXPECT_GT(bound, 0);
}

}  // namespace
}  // namespace waymark::test
