// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/wheeled_vehicle.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "testbed/drive/dynamic_vehicle.hpp"
#include "tests/testbed/dynamics/made_ground.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

using ::testing::HasSubstr;

constexpr double kMars = 3.71;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}
Terrain slope_east(double degrees) {
  return plane(std::tan(radians(degrees)), 0);
}
Terrain slope_north(double degrees) {
  return plane(0, std::tan(radians(degrees)));
}

TEST(WheeledVehicle, StandsInItsOwnTracks) {
  const Terrain level = plane(0, 0);
  const DrivingSurface surface(level, {});
  for (const char* name : {"rover", "field_robot"}) {
    const planning::Vehicle vehicle = planning::find_vehicle(name);
    const WheeledVehicle stands(vehicle, {}, kMars, surface, {1, 2, 0.7});
    double load = 0;
    for (const WheeledVehicle::Wheel& wheel : stands.wheels()) load += wheel.load;
    EXPECT_NEAR(load, vehicle.mass * kMars, 0.002 * load) << name;
    const localization::TerrainPose at = stands.pose();
    EXPECT_NEAR(at.z, -stands.wheels()[0].sinkage, 1e-3) << name;
    EXPECT_NEAR(at.plane.x, 1, 1e-3);
    EXPECT_NEAR(at.plane.yaw, 0.7, 1e-3);
    EXPECT_NEAR(at.roll, 0, 1e-3);
    EXPECT_FALSE(stands.grounded());
  }
}

TEST(WheeledVehicle, HoldsOnASlopeUpToTheStrengthOfTheSoil) {
  const planning::Vehicle rover = planning::find_vehicle("rover");
  const auto slides = [&](double degrees, Degrees friction) {
    const Terrain terrain = slope_east(degrees);
    const DrivingSurface surface(terrain, {});
    WheeledVehicle vehicle(rover, {.friction = friction, .cohesion = 0}, kMars, surface, {0, 0, 0});
    const double before = vehicle.pose().plane.x;
    vehicle.drive(0, 0, 5);
    return before - vehicle.pose().plane.x;
  };
  EXPECT_LT(std::abs(slides(20, Degrees{35})), 0.02);
  EXPECT_GT(slides(30, Degrees{15}), 1);
}

// The steady slip of a rover in closed form, from equal loads and the balance of forces.
TEST(WheeledVehicle, SlipsAsTheBalanceOfForcesDemands) {
  const planning::Vehicle rover = planning::find_vehicle("rover");
  for (const double degrees : {0.0, 6.0, 12.0}) {
    const Terrain terrain = slope_east(degrees);
    const DrivingSurface surface(terrain, {});
    WheeledVehicle vehicle(rover, {}, kMars, surface, {-15, 0, 0});
    vehicle.drive(0.1, 0, 10);
    const localization::TerrainPose before = vehicle.pose();
    vehicle.drive(0.1, 0, 60);
    const localization::TerrainPose after = vehicle.pose();
    const double driven = std::hypot(after.plane.x - before.plane.x, after.z - before.z);
    const double slip = 1 - driven / 6;
    const double steady = steady_slip(rover, {}, kMars, radians(degrees), 0).along;
    EXPECT_NEAR(slip, steady, 0.02 + 0.1 * steady) << degrees << " degrees";
    EXPECT_NEAR(after.pitch, -radians(degrees), radians(1.5));
  }
}

TEST(WheeledVehicle, SlipsSidewaysOnACrossSlope) {
  const planning::Vehicle rover = planning::find_vehicle("rover");
  const Terrain terrain = slope_north(10);
  const DrivingSurface surface(terrain, {});
  WheeledVehicle vehicle(rover, {}, kMars, surface, {-15, 0, 0});
  vehicle.drive(0.1, 0, 10);
  const localization::TerrainPose before = vehicle.pose();
  vehicle.drive(0.1, 0, 60);
  const localization::Pose2 moved = inverse(before.plane) * vehicle.pose().plane;
  const double steady = steady_slip(rover, {}, kMars, 0, radians(10)).across;
  EXPECT_NEAR(-moved.y / moved.x, steady, 0.3 * steady);
}

TEST(WheeledVehicle, TurnsAsItsWheelsAreSteered) {
  const planning::Vehicle rover = planning::find_vehicle("rover");
  const Terrain level = plane(0, 0);
  const DrivingSurface surface(level, {});
  WheeledVehicle vehicle(rover, {}, kMars, surface, {0, 0, 0});
  vehicle.drive(0, 0.1, 10);
  EXPECT_NEAR(vehicle.pose().plane.yaw, 1, 0.15);
  EXPECT_LT(vehicle.pose().plane.at().norm(), 0.05) << "it turns on the spot";
}

// A vehicle falls over its lower wheels where its centre of mass is beside them.
TEST(WheeledVehicle, TipsOverBesideItsStaticLimit) {
  planning::Vehicle tall = planning::find_vehicle("field_robot");
  tall.centre_of_mass = Meters{0.6};
  tall.belly_clearance = Meters{0.3};
  const Soil rough{.friction = Degrees{58}, .cohesion = 1000, .stiffness = 1e8};
  const auto tips = [&](double degrees) {
    const Terrain terrain = slope_north(degrees);
    const DrivingSurface surface(terrain, {});
    WheeledVehicle vehicle(tall, rough, 9.81, surface, {0, 0, 0});
    vehicle.drive(0, 0, 20);
    return vehicle.tipped_over();
  };
  // Wheels touch at their middle. The lower springs give way by 2 cm and more, about three degrees.
  const double limit = std::atan2(0.28, 0.6) * 180 / std::numbers::pi;
  EXPECT_FALSE(tips(limit - 9)) << limit;
  EXPECT_TRUE(tips(limit + 1)) << limit;
}

// Virtual work: with equal loads, a wheel that rises by h raises the centre of mass by a sixth of it.
TEST(WheeledVehicle, ARockUnderOneWheelRaisesTheBodyByItsShare) {
  const planning::Vehicle rover = planning::find_vehicle("rover");
  const Terrain level = plane(0, 0);
  constexpr double kTop = 0.15;
  const std::vector<RockSolid> rocks{rock_at({3, 1.2, 0}, 0.3, kTop)};
  const DrivingSurface surface(level, rocks);
  const Soil hard{.stiffness = 1e8};
  WheeledVehicle vehicle(rover, hard, kMars, surface, {0, 0, 0});
  const double at_rest = vehicle.body().position.z();
  double highest = 0, roll = 0;
  bool on_rock = false;
  for (int i = 0; i < 400; ++i) {
    vehicle.drive(0.1, 0, 0.1);
    if (vehicle.pose().plane.x > 2.4) break;  // the front wheel alone has passed
    highest = std::max(highest, vehicle.body().position.z() - at_rest);
    roll = std::max(roll, std::abs(vehicle.pose().roll));
    on_rock |= vehicle.wheels()[0].on_rock;
  }
  EXPECT_TRUE(on_rock);
  EXPECT_NEAR(highest, kTop / 6, 0.3 * kTop / 6);
  EXPECT_GT(roll, 0.005);
  EXPECT_LT(roll, 0.1);
}

TEST(WheeledVehicle, ARockHigherThanTheBellyHoldsIt) {
  planning::Vehicle low = planning::find_vehicle("field_robot");
  low.belly_clearance = Meters{0.06};
  const Terrain level = plane(0, 0);
  const std::vector<RockSolid> rocks{rock_at({1.5, 0, 0}, 0.12, 0.2)};
  const DrivingSurface surface(level, rocks);
  WheeledVehicle vehicle(low, {}, 9.81, surface, {0, 0, 0});
  bool touched = false;
  for (int i = 0; i < 200; ++i) {
    vehicle.drive(0.2, 0, 0.1);
    touched |= vehicle.grounded();
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(vehicle.pose().plane.x, 3) << "of 4 m without the rock";
}

TEST(WheeledVehicle, IsTheSameEachTime) {
  const planning::Vehicle rover = planning::find_vehicle("rover");
  const Terrain terrain = plane(0.1, 0.05);
  const std::vector<RockSolid> rocks{rock_at({2, 1, 0.25}, 0.3, 0.2), rock_at({4, -1.2, 0.3}, 0.4, 0.2)};
  const auto end = [&] {
    const DrivingSurface surface(terrain, rocks);
    WheeledVehicle vehicle(rover, {}, kMars, surface, {0, 0, 0.2});
    for (int i = 0; i < 50; ++i) vehicle.drive(0.2, 0.01 * i, 0.2);
    return vehicle.body();
  };
  const RigidBody first = end(), second = end();
  EXPECT_EQ(first.position, second.position);
  EXPECT_EQ(first.attitude.coeffs(), second.attitude.coeffs());
}

TEST(WheeledVehicle, SaysWhyItCannotDrive) {
  const Terrain level = plane(0, 0);
  const DrivingSurface surface(level, {});
  planning::Vehicle light = planning::find_vehicle("rover");
  light.mass = 0;
  const auto refusal = [&](const planning::Vehicle& vehicle,
                           const localization::Pose2& start) -> std::string {
    try {
      WheeledVehicle made(vehicle, {}, kMars, surface, start);
      made.drive(1, 0, 60);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(light, {}), HasSubstr("has no mass"));
  EXPECT_THAT(refusal(planning::find_vehicle("rover"), {40, 0, 0}), HasSubstr("begins outside the terrain"));
  EXPECT_THAT(refusal(planning::find_vehicle("rover"), {}), HasSubstr("leaves the terrain at 30"));
}

}  // namespace
}  // namespace waymark::test
