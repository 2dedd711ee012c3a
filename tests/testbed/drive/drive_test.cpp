// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "localization/detectors/laser_stems.hpp"
#include "localization/motion_model.hpp"
#include "testbed/drive/drive_log.hpp"
#include "testbed/drive/drive_route.hpp"
#include "testbed/drive/ray_fan.hpp"
#include "testbed/scenario.hpp"
#include "tests/testbed/dead_reckoning.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Terrain slope(double forward, double left, double side = 60) {
  const auto nodes = static_cast<std::int64_t>(side) + 1;
  Grid<float> heights(nodes, nodes);
  for (std::int64_t r = 0; r < nodes; ++r)
    for (std::int64_t c = 0; c < nodes; ++c)
      heights(c, r) = static_cast<float>(forward * (double(c) - side / 2) + left * (side / 2 - double(r)));
  return {std::move(heights), -side / 2, side / 2, 1, 1};
}

SiteModel drive_site() {
  SiteModel ground;
  ground.width = ground.height = 90;
  ground.cell = 0.5;
  ground.relief.rms = 0.5;
  ground.craters.max_diameter = 15;
  ground.rocks = {.k = 0.12, .min_diameter = 0.4, .max_diameter = 3};
  ground.dunes.cover = 0;
  return ground;
}

std::vector<StandingTree> rows_of_trees(const Terrain& terrain) {
  std::vector<StandingTree> trees;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) {
      const double x = 5.5 * i + 1, y = 5.5 * j + 0.7 * i;
      if (const auto z = terrain.height(x, y))
        trees.push_back({.foot = {x, y, *z},
                         .height = 20,
                         .dbh = 0.15 + 0.03 * (i + 4),
                         .crown_diameter = 4,
                         .crown_base = 9});
    }
  return trees;
}

TEST(RayFan, MeetsWhatAskingEveryTargetMeets) {
  const Scene scene = make_scene(drive_site(), 5);
  const auto trees = rows_of_trees(scene.terrain);
  ForestSolids solids = forest_solids(trees, {}, scene.terrain, 5);
  solids.thickets.clear();  // where a beam ends in one is drawn
  const LaserTargets targets(scene.terrain, scene.solids, solids.stems);
  Random random(7);
  int stems = 0, rocks = 0;
  for (int place = 0; place < 20; ++place) {
    const double x = random.uniform(-30, 30), y = random.uniform(-30, 30);
    const RayFan fan(targets, {x, y, *scene.terrain.height(x, y) + random.uniform(0.3, 2)}, 30);
    for (int k = 0; k < 200; ++k) {
      const double a = random.uniform(-4, 4), e = random.uniform(-0.1, 0.05);
      const Eigen::Vector3d along(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
      const auto hit = fan.cast(along), slow = fan.cast_exhaustively(along);
      ASSERT_EQ(hit.has_value(), slow.has_value()) << "place " << place << ", ray " << k;
      if (!hit) continue;
      EXPECT_EQ(hit->range, slow->range);
      EXPECT_EQ(hit->index, slow->index);
      stems += hit->kind == TargetKind::stem, rocks += hit->kind == TargetKind::rock;
    }
  }
  EXPECT_GT(stems, 100);
  EXPECT_GT(rocks, 50);
}

TEST(RayFan, AFelledTreeIsGone) {
  StemSolid stem{.foot = {10, 0, 0}, .dbh = 0.4, .height = 20};
  stem.felled_at = 7;
  const LaserTargets targets(slope(0, 0), {}, {stem});
  const Eigen::Vector3d eye(0, 0, 1.3), ahead(1, 0, 0);
  ASSERT_TRUE(RayFan(targets, eye, 30, 6).cast(ahead));
  EXPECT_NEAR(RayFan(targets, eye, 30, 6).cast(ahead)->range, 9.8, 1e-6);
  EXPECT_FALSE(RayFan(targets, eye, 30, 7).cast(ahead));
}

TEST(LaserScanner, AWideBeamSeesStemsWiderAndTheDetectorKnows) {
  const LaserTargets targets(slope(0, 0), {}, {StemSolid{.foot = {8, 0.01, 0}, .dbh = 0.3, .height = 20}});
  const RayFan fan(targets, {0, 0, 1.3}, 30);
  LaserModel laser{.field = Degrees{60},
                   .divergence = Degrees{0.5},
                   .rays = 9,
                   .range_sd = 0,
                   .dropouts = 0,
                   .clutter = 0,
                   .mixed = 0};
  laser.step = Degrees{0.05};
  Random random(1);
  localization::LaserScan scan = sweep(fan, Eigen::Matrix3d::Identity(), laser, random);
  localization::LaserStemOptions options;
  options.min_beams = 3;
  const auto uncorrected = localization::find_stems(scan, options);
  scan.beam_width = to_radians(laser.divergence).value * (1 - 2 * laser.sensitivity);
  const auto corrected = localization::find_stems(scan, options);
  ASSERT_EQ(uncorrected.size(), 1u);
  ASSERT_EQ(corrected.size(), 1u);
  EXPECT_GT(uncorrected[0].diameter, 0.32);
  EXPECT_NEAR(corrected[0].diameter, 0.3, 0.012) << "two beams are 1.4 cm";
  EXPECT_NEAR(corrected[0].range, std::hypot(8, 0.01), 0.01);
}

TEST(Route, GoesRoundObstaclesOrSaysThereIsNoWay) {
  const Terrain flat = slope(0, 0);
  const std::vector<Obstacle> wall{{{0, 0}, 6}};
  const TraversableMap ground(flat, wall, 1.5, 2, 0.4);
  const auto path = ground.shortest_path({-15, 0}, {15, 0});
  ASSERT_GE(path.size(), 3u);
  for (const Eigen::Vector2d& at : smooth_path(path, 0.5)) EXPECT_GT(at.norm(), 6.5);
  const TraversableMap closed(flat, std::vector<Obstacle>{{{0, 0}, 6}, {{15, 0}, 4}}, 40, 2, 0.4);
  EXPECT_TRUE(closed.shortest_path({-15, 0}, {15, 0}).empty());
}

TEST(Drive, OdometryWithoutErrorsIsTheTruth) {
  const Terrain flat = slope(0, 0);
  DriveSettings settings;
  settings.odometry.perfect = true;
  const std::vector<Eigen::Vector2d> path = smooth_path({{-20, -20}, {10, -15}, {20, 20}, {-5, 5}}, 0.5);
  const auto steps = drive_along(flat, {}, path, settings, 1).steps;
  localization::Pose2 odometry = steps.front().at.plane;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const double dt = steps[i + 1].t - steps[i].t;
    odometry = odometry * localization::twist_motion(steps[i].speed, 0, steps[i].turn, dt, {}).step;
  }
  EXPECT_NEAR((odometry.at() - steps.back().at.plane.at()).norm(), 0, 0.02);
  EXPECT_NEAR((steps.back().at.plane.at() - path.back()).norm(), 0, 2);
}

// The noise stated in the log must be that of the odometry: dead reckoning errs by as much as it claims.
TEST(Drive, OdometryErrsAsTheLogStates) {
  const Scene scene = make_scene(drive_site(), 5);
  double squares = 0;
  constexpr int kDrives = 40;
  for (int k = 0; k < kDrives; ++k) {
    DriveSettings settings;
    settings.length = 60, settings.seed = 100 + k;
    const DriveWorld world = make_drive(settings, scene, {}, 5);
    squares += squared_error_of_odometry(world) / kDrives;
  }
  // 40 drives of two coordinates: 0.71 to 1.33 (95 %) if all errors were Gaussian and the slopes alike.
  EXPECT_GT(squares, 0.5);
  EXPECT_LT(squares, 1.5);
}

std::string log_on(int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const Scene scene = make_scene(drive_site(), 3);
  DriveSettings settings;
  settings.length = 30;
  settings.laser.step = Degrees{1};
  settings.gnss.on = true;
  return drive_log(make_drive(settings, scene, {}, 3), {});
}

TEST(Drive, TheSameBytesForAnyNumberOfThreads) {
  const std::string one = log_on(1);
  EXPECT_EQ(one, log_on(2));
  EXPECT_THAT(one, StartsWith("{\"kind\":\"header\""));
  for (const char* kind : {"odometry", "truth", "laser", "gnss"})
    EXPECT_THAT(one, HasSubstr(std::string("{\"kind\":\"") + kind)) << kind;
}

TEST(Drive, AHarvesterFellsWhatStandsInItsWay) {
  SiteModel ground = drive_site();
  ground.rocks.k = 0;
  ground.craters.density = 0;
  const Scene scene = make_scene(ground, 4);
  DriveSettings settings;
  settings.vehicle = "harvester";
  settings.route = "waypoints";
  settings.waypoints = {{-20, 2}, {20, -3}};
  settings.laser.step = Degrees{1};
  const DriveWorld world = make_drive(settings, scene, rows_of_trees(scene.terrain), 4);
  ASSERT_GE(world.felled.size(), 3u);
  for (const DriveStep& step : world.steps)
    for (std::size_t i = 0; i < world.trees.size(); ++i) {
      if ((world.trees[i].foot.head<2>() - step.at.plane.at()).norm() > 1.5) continue;
      EXPECT_LE(world.targets.stems()[i].felled_at, step.t) << "it drove through tree " << i;
    }
  const std::string log = drive_log(world, {});
  EXPECT_THAT(log, HasSubstr("\"kind\":\"felled\""));
  EXPECT_THAT(standing_table(world, {}), HasSubstr("\ntree,"));
}

std::string refusal_of_drive(const std::string& drive) {
  try {
    read_scenario(R"({"waymark_scenario": 1, "flights": [], "drive": )" + drive + "}", "s.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DriveSection, SaysWhatIsWrongWithIt) {
  EXPECT_EQ(refusal_of_drive("{}"), "accepted");
  EXPECT_THAT(refusal_of_drive("3"), HasSubstr("drive must be an object"));
  EXPECT_THAT(refusal_of_drive(R"({"speeed": 1})"), HasSubstr("did you mean 'speed'"));
  EXPECT_THAT(refusal_of_drive(R"({"laser": {"step": 0}})"), HasSubstr("drive.laser.step = 0 is outside"));
  EXPECT_THAT(refusal_of_drive(R"({"route": "waypoints"})"), HasSubstr("drive.waypoints is missing"));
  EXPECT_THAT(refusal_of_drive(R"({"waypoints": [[1, 2], [3]]})"),
              HasSubstr("drive.waypoints[1] must be [east, north]"));
  EXPECT_THAT(refusal_of_drive(R"({"vehicle": "tank"})"), HasSubstr("must be one of rover, harvester"));
}

TEST(DriveSection, ComesBackAsItWasWritten) {
  const Scenario scenario = read_scenario(
      R"({"waymark_scenario": 1, "flights": [], "ground": {"width": 50, "height": 50},
          "drive": {"waypoints": [[1, 2], [3, 4]], "laser": {"step": 0.5}, "odometry": {"slip": 0.1}}})",
      "s.json");
  const std::string text = scenario_json(scenario);
  EXPECT_EQ(scenario_json(read_scenario(text, "again")), text);
  EXPECT_EQ(read_scenario(text, "again").drive.laser.step.value, 0.5);
}

TEST(TreeTable, IsReadWithWhatItHas) {
  const Terrain flat = slope(0, 0);
  const auto trees = trees_from_table(
      "tree_id,stand_id,year,dbh,x_coord,y_coord\n1,A,2000,30,0,0\n1,A,2010,40,0,0\n"
      "2,A,2010,20,10,4\n3,B,2010,20,900,4\n4,A,2010,,5,5\n",
      "t.csv", "A", {0, 0}, flat);
  ASSERT_EQ(trees.size(), 2u);
  EXPECT_NEAR(trees[0].dbh, 0.4, 1e-12);
  EXPECT_NEAR(trees[0].foot.x(), -5, 1e-12);
  EXPECT_THROW(trees_from_table("a,b\n1,2\n", "t.csv", "", {0, 0}, flat), Error);
  EXPECT_THROW(trees_from_table("x,y,dbh\n", "t.csv", "", {0, 0}, flat), Error);
}

}  // namespace
}  // namespace waymark::test
