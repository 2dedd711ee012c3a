// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/leg_planner.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_routes.hpp"

namespace waymark::test {
namespace {

using workflows::LegPlanner;

LegPlanner planner_of(const workflows::RouteRequest& request) {
  const planning::LandmarkSensing seen = sensing(12);
  LegPlanner planner(request, scattered_landmarks(3), seen.coverage);
  planner.problem = problem_of(41, 41, planner.landmarks, seen);
  planner.before.emplace(planner.problem.start, planner.odometry, planner.landmarks, 2, 1);
  return planner;
}

// A weighted leg bounds its search by what drives from its start have at least: another leg must not use
// that.
TEST(LegPlanner, BoundsOfALegAreForgotten) {
  workflows::RouteRequest request;
  request.weight = 2;
  const std::int64_t south_west = 0, north_east = 41 * 41 - 1;
  LegPlanner both = planner_of(request), one = planner_of(request);
  both.begin_leg(south_west, north_east);
  both.leg();
  ASSERT_FALSE(both.problem.min_sd.empty());
  both.begin_leg(north_east, south_west);
  one.begin_leg(north_east, south_west);
  EXPECT_TRUE(both.problem.min_sd.empty());
  EXPECT_EQ(both.problem.to_go, one.problem.to_go);
  const auto after = both.search({.weight = 2}), alone = one.search({.weight = 2});
  ASSERT_TRUE(after && alone);
  EXPECT_EQ(after->cost, alone->cost);
  EXPECT_EQ(after->length, alone->length);
}

}  // namespace
}  // namespace waymark::test
