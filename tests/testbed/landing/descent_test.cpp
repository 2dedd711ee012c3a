// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/descent.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "core/error.hpp"
#include "testbed/landing/flight.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

using ::testing::HasSubstr;

const Eigen::Vector3d kFrom(300, -200, 4000), kTo(20, 30, 8);

double lean_degrees(const RigidBody& body) {
  return std::acos(std::clamp((body.attitude * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0)) * 180 /
         std::numbers::pi;
}

TEST(Descent, LandsWhereItWasSentForAnyWind) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const auto states = simulate_descent({}, kFrom, kTo, seed);
    const RigidBody& end = states.back().body;
    EXPECT_LT((end.position - kTo).head<2>().norm(), 1) << seed;
    EXPECT_NEAR(end.position.z(), 8, 0.1);
    EXPECT_NEAR(end.velocity.z(), -0.75, 0.1);
    EXPECT_LT(end.velocity.head<2>().norm(), 0.2);
    EXPECT_LT(lean_degrees(end), 3);
    EXPECT_EQ(states.back().phase, DescentPhase::crane);
    EXPECT_GT(states.back().t, 50);
    EXPECT_LT(states.back().t, 180);
  }
}

TEST(Descent, SwingsUnderTheParachuteAtItsSpeed) {
  const auto states = simulate_descent({}, kFrom, kTo, 7);
  double speed = 0, swung = 0, before = 0;
  int count = 0, turns = 0;
  for (const DescentState& state : states) {
    if (state.phase != DescentPhase::parachute) break;
    speed += -state.body.velocity.z(), ++count;
    swung = std::max(swung, lean_degrees(state.body));
    const double east = (state.body.attitude * Eigen::Vector3d::UnitZ()).x();
    turns += east * before < 0 ? 1 : 0;
    before = east;
  }
  EXPECT_NEAR(speed / count, 85, 8);
  EXPECT_GT(swung, 4);
  EXPECT_LT(swung, 30);
  EXPECT_GE(turns, 3) << "it swings to and fro";
}

TEST(Descent, WithoutWindAndSwingItFallsStraight) {
  const DescentModel calm{.swing = Degrees{0}, .wind = 0};
  for (const DescentState& state : simulate_descent(calm, {0, 0, 4000}, {0, 0, 8}, 1)) {
    ASSERT_LT(state.body.position.head<2>().norm(), 1e-6);
    ASSERT_LT(lean_degrees(state.body), 1e-4);
  }
}

TEST(Descent, TheThrustIsThatOfTheEngines) {
  const auto states = simulate_descent({}, kFrom, kTo, 3);
  for (std::size_t i = 1; i < states.size(); ++i) {
    if (states[i - 1].phase == DescentPhase::parachute) continue;
    const Eigen::Vector3d acceleration =
        (states[i].body.velocity - states[i - 1].body.velocity) / (states[i].t - states[i - 1].t);
    EXPECT_LT((acceleration + Eigen::Vector3d(0, 0, 3.71)).norm(), 4.05 * 3.71);
  }
}

TEST(Descent, RefusesAltitudesOutOfOrder) {
  const auto refusal = [](const DescentModel& model, double from, double to) -> std::string {
    try {
      simulate_descent(model, {0, 0, from}, {0, 0, to}, 1);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal({}, 100, 200), HasSubstr("altitudes fall"));
  EXPECT_THAT(refusal({.powered_altitude = 10}, 100, 5), HasSubstr("altitudes fall"));
  EXPECT_THAT(refusal({}, 4000, 30), HasSubstr("altitudes fall"));
  EXPECT_EQ(refusal({}, 1500, 10), "accepted") << "already under rockets";
}

// The shield is released above, falls faster than the lander and is gone before it lands.
TEST(Descent, TheHeatShieldFallsAheadOfTheLander) {
  Scenario scenario;
  Flight& flight = scenario.flights[0];
  flight.path = "landing";
  flight.images = 40;
  flight.from_altitude = 4000, flight.to_altitude = 10;
  for (const Shot& shot : plan_shots(scenario)) EXPECT_EQ(shot.shield.radius, 0);
  flight.heat_shield = 4.5;
  double last = 0;
  std::size_t seen = 0;
  for (const Shot& shot : plan_shots(scenario)) {
    if (!(shot.shield.radius > 0)) continue;
    const double below = shot.view.centre().xyz.z() - shot.shield.centre.z();
    EXPECT_GT(below, last);
    EXPECT_GT(shot.shield.centre.z(), scenario.ground.up);
    EXPECT_NEAR(shot.shield.normal.norm(), 1, 1e-12);
    last = below;
    ++seen;
  }
  EXPECT_GT(seen, 5u);
  EXPECT_LT(seen, 30u);
}

TEST(Descent, DustThickensTowardsTheGround) {
  Scenario scenario;
  Flight& flight = scenario.flights[0];
  flight.path = "landing";
  flight.images = 60;
  flight.from_altitude = 2500, flight.to_altitude = 10;
  flight.dust = 3;
  double last = 0;
  for (const Shot& shot : plan_shots(scenario)) {
    const double altitude = shot.view.centre().xyz.z() - scenario.ground.up;
    EXPECT_EQ(shot.dust.depth > 0, altitude < 60) << altitude;
    EXPECT_GE(shot.dust.depth, last - 1e-9);
    EXPECT_LE(shot.dust.depth, 3);
    last = shot.dust.depth;
    if (shot.dust.depth > 0) {
      EXPECT_LT(dust_depth(shot.dust, shot.dust.centre.x() + 400, shot.dust.centre.y()), 0.1);
    }
  }
  EXPECT_GT(last, 1);
}

TEST(Descent, ALandingHasOneLine) {
  Scenario scenario;
  Flight& flight = scenario.flights[0];
  flight.path = "landing";
  flight.images = 3, flight.lines = 2;
  flight.from_altitude = 800, flight.to_altitude = 10;
  EXPECT_THROW(plan_shots(scenario), Error);
  flight.lines = 1;
  const std::vector<Shot> shots = plan_shots(scenario);
  ASSERT_EQ(shots.size(), 3u);
  EXPECT_GT(shots[0].motion.velocity.norm(), 1);
  EXPECT_NEAR(shots[2].view.grid_from_camera.transform.translation().z() - scenario.ground.up, 10, 0.1);
}

}  // namespace
}  // namespace waymark::test
