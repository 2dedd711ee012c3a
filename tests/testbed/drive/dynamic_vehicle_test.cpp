// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/dynamic_vehicle.hpp"

#include <gtest/gtest.h>

#include "testbed/drive/drive.hpp"
#include "testbed/drive/drive_world.hpp"
#include "tests/testbed/dead_reckoning.hpp"
#include "tests/testbed/dynamics/made_ground.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

SiteModel rough_site() {
  SiteModel ground;
  ground.width = ground.height = 90;
  ground.cell = 0.5;
  ground.relief.rms = 0.5;
  ground.craters.max_diameter = 15;
  ground.rocks = {.k = 0.04, .min_diameter = 0.4, .max_diameter = 3};
  ground.dunes.cover = 0;
  return ground;
}

DriveSettings with_dynamics() {
  DriveSettings settings;
  settings.dynamics.on = true;
  return settings;
}

TEST(DynamicVehicle, DrivesARouteOverARoughSite) {
  const Scene scene = make_scene(rough_site(), 5);
  DriveSettings settings = with_dynamics();
  settings.length = 60;
  const DriveWorld world = make_drive(settings, scene, {}, 5);
  EXPECT_EQ(world.mishap, "");
  EXPECT_NEAR((world.steps.back().at.plane.at() - world.path.back()).norm(), 0, 2);
  double measured = 0, lean = 0;
  for (std::size_t i = 0; i + 1 < world.steps.size(); ++i) {
    measured += world.steps[i].speed * (world.steps[i + 1].t - world.steps[i].t);
    lean = std::max(lean, std::abs(world.steps[i].at.roll));
  }
  const double driven = world.steps.back().distance;
  EXPECT_GT(measured, 1.01 * driven) << "wheels slip";
  EXPECT_LT(measured, 1.5 * driven);
  EXPECT_GT(lean, 0.01);
}

// The noise stated in the log must be that of the odometry.
TEST(DynamicVehicle, OdometryErrsAsTheLogStates) {
  const Scene scene = make_scene(rough_site(), 5);
  double squares = 0;
  constexpr int kDrives = 20;
  for (int k = 0; k < kDrives; ++k) {
    DriveSettings settings = with_dynamics();
    settings.length = 40, settings.seed = 200 + k;
    const DriveWorld world = make_drive(settings, scene, {}, 5);
    squares += squared_error_of_odometry(world) / kDrives;
  }
  EXPECT_GT(squares, 0.3);
  EXPECT_LT(squares, 2);
}

TEST(DynamicVehicle, WithoutErrorsOdometryIsTheMotion) {
  const Terrain level = plane(0, 0);
  DriveSettings settings = with_dynamics();
  settings.odometry.perfect = true;
  DynamicVehicle vehicle(level, {}, settings, {0, 0, 0}, 1);
  double measured = 0;
  for (int i = 0; i < 100; ++i) measured += vehicle.step({0.3, 0}).speed / settings.odometry.rate;
  EXPECT_NEAR(measured, vehicle.now().at.plane.x, 0.1);
  EXPECT_LT(measured, 0.3 * 20) << "less than the rims";
}

TEST(DynamicVehicle, IsStuckWhereSoilCannotHold) {
  const Terrain steep = plane(0.364, 0);
  DriveSettings settings = with_dynamics();
  settings.dynamics.soil.friction = Degrees{30};
  settings.dynamics.soil.cohesion = 0;
  const PathDrive drive = drive_along(
      steep, {}, std::vector<Eigen::Vector2d>{{0, 0}, {2, 0}, {4, 0}, {6, 0}, {9, 0}}, settings, 1);
  EXPECT_EQ(drive.mishap, "stuck");
}

TEST(DynamicVehicle, TipsOverOnAWallAndSaysSo) {
  const Terrain steep = plane(0, 2.5);
  DriveSettings settings = with_dynamics();
  settings.dynamics.soil.friction = Degrees{60};
  settings.dynamics.soil.cohesion = 1e5;
  DynamicVehicle vehicle(steep, {}, settings, {0, 0, 0}, 1);
  EXPECT_EQ(vehicle.mishap(), "tipped over");
}

TEST(DynamicVehicle, IsThatOfTheDriveUnlessAnotherIsNamed) {
  const Terrain level = plane(0, 0);
  DriveSettings settings = with_dynamics();
  settings.vehicle = "harvester";
  EXPECT_EQ(DynamicVehicle(level, {}, settings, {0, 0, 0}, 1).vehicle().body().mass, 20000);
  settings.dynamics.vehicle = "field_robot";
  EXPECT_EQ(DynamicVehicle(level, {}, settings, {0, 0, 0}, 1).vehicle().body().mass, 50);
}

}  // namespace
}  // namespace waymark::test
