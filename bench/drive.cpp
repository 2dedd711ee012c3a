// SPDX-License-Identifier: Apache-2.0
// Rays of the line scanners: a rover among rocks, a harvester among stems. One thread; items are rays.
// Dynamics of a rover among rocks: items are steps of 2.5 ms.
#include <benchmark/benchmark.h>

#include <cmath>

#include "testbed/drive/laser_scanner.hpp"
#include "testbed/dynamics/wheeled_vehicle.hpp"
#include "testbed/scene.hpp"

namespace waymark::bench {
namespace {

testbed::Scene site(double rocks) {
  testbed::SiteModel ground;
  ground.width = ground.height = 150;
  ground.cell = 0.3;
  ground.relief = {.rms = 2, .longest = 250, .roughness = 0.5};
  ground.craters.density = 0.3;
  ground.rocks = {.k = rocks, .min_diameter = 0.5, .max_diameter = 4};
  return testbed::make_scene(ground, 11);
}

void scan_at_random_poses(benchmark::State& state, const testbed::LaserTargets& targets, double height) {
  const testbed::LaserModel laser{.field = Degrees{240}};
  Random random(1);
  for (auto _ : state) {
    const double x = random.uniform(-50, 50), y = random.uniform(-50, 50);
    const testbed::RayFan fan(targets, {x, y, *targets.terrain().height(x, y) + height}, laser.max_range);
    benchmark::DoNotOptimize(testbed::sweep(fan, Eigen::Matrix3d::Identity(), laser, random));
  }
  state.SetItemsProcessed(state.iterations() * laser.beams() * laser.rays);
}

void rover_scan(benchmark::State& state) {
  const testbed::Scene scene = site(0.16);
  scan_at_random_poses(state, testbed::LaserTargets(scene.terrain, scene.solids), 0.3);
}
BENCHMARK(rover_scan)->Unit(benchmark::kMillisecond);

void harvester_scan(benchmark::State& state) {
  const testbed::Scene scene = site(0);
  Random random(2);
  std::vector<testbed::StandingTree> trees;
  for (int i = 0; i < 1125; ++i) {  // 500 per hectare
    const double x = random.uniform(-74, 74), y = random.uniform(-74, 74);
    trees.push_back({.foot = {x, y, *scene.terrain.height(x, y)},
                     .height = 20,
                     .dbh = random.uniform(0.1, 0.45),
                     .crown_diameter = 4,
                     .crown_base = 9});
  }
  testbed::ForestSolids solids = testbed::forest_solids(trees, {}, scene.terrain, 3);
  scan_at_random_poses(state, testbed::LaserTargets(scene.terrain, {}, solids.stems, solids.thickets), 2);
}
BENCHMARK(harvester_scan)->Unit(benchmark::kMillisecond);

void rover_dynamics(benchmark::State& state) {
  const testbed::Scene scene = site(0.08);
  const testbed::DrivingSurface surface(scene.terrain, scene.solids);
  const planning::Vehicle rover = planning::find_vehicle("rover");
  for (auto _ : state) {
    testbed::WheeledVehicle vehicle(rover, {}, 3.71, surface, {0, 0, 0});
    vehicle.drive(0.3, 0.02, 60);  // a circle of 15 m
    benchmark::DoNotOptimize(vehicle.pose());
  }
  state.SetItemsProcessed(state.iterations() * 24000);
}
BENCHMARK(rover_dynamics)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
