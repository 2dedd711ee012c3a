// SPDX-License-Identifier: Apache-2.0
// Updates of the filters: particles times sightings on maps of 1e3 to 1e7 landmarks at one density, and
// Kalman updates. One thread.
#include <benchmark/benchmark.h>

#include "localization/detectors/laser_stems.hpp"
#include "localization/kalman.hpp"
#include "localization/particle_filter.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::testing {
namespace {

constexpr double kDensity = 0.02;  // landmarks per square metre

SightingSet sightings(std::size_t count) {
  Random random(1, "sightings");
  SightingSet set;
  for (std::size_t i = 0; i < count; ++i) {
    SeenLandmark s;
    s.type = TypeId{0};
    s.range = random.uniform(3, 20);
    s.bearing = random.uniform(-1.5, 1.5);
    s.features.value[0] = random.uniform(0.2, 1);
    s.features.variance[0] = 0.01;
    set.sightings.push_back(s);
  }
  return set;
}

LandmarkGrid map_of(std::size_t landmarks) {
  auto all = strewn(landmarks, std::sqrt(static_cast<double>(landmarks) / kDensity), 1);
  Random random(1, "features");
  for (MapLandmark& l : all) l.features.value[0] = random.uniform(0.2, 1);
  return LandmarkGrid(std::move(all));
}

/// Weighing of particles within a metre of each other, features compared.
void weigh(benchmark::State& state) {
  const LandmarkGrid map = map_of(static_cast<std::size_t>(state.range(0)));
  const auto particles = static_cast<std::size_t>(state.range(1));
  const SightingSet seen = sightings(static_cast<std::size_t>(state.range(2)));
  Random random(1, "particles");
  std::vector<Pose2> poses(particles);
  for (Pose2& p : poses) p = {random.normal(), random.normal(), 0.1 * random.normal()};
  const FeatureScales scales;
  double sum = 0;
  for (auto _ : state) {
    const SightingScore score(seen, map, scales, {}, false);
    for (const Pose2& p : poses) sum += score(p);
  }
  benchmark::DoNotOptimize(sum);
  state.counters["evaluations/s"] = benchmark::Counter(
      static_cast<double>(particles * seen.sightings.size()) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
}
BENCHMARK(weigh)
    ->ArgNames({"landmarks", "particles", "sightings"})
    ->Args({1000, 1000, 8})
    ->Args({100000, 1000, 8})
    ->Args({1000000, 1000, 8})
    ->Args({50000, 1000, 3})
    ->Unit(benchmark::kMicrosecond);

/// What a window of a map of any size costs once it is cached: the same question to a window of 200 m.
void weigh_in_window(benchmark::State& state) {
  LandmarkWindow window(
      [](const Eigen::AlignedBox2d& box) {
        return strewn(static_cast<std::size_t>(kDensity * box.volume()), box.sizes().x(), 1);
      },
      100);
  const SightingSet seen = sightings(8);
  const FeatureScales scales;
  double sum = 0;
  for (auto _ : state) {
    const SightingScore score(seen, window.around({0, 0}, 30), scales, {}, false);
    for (int i = 0; i < 1000; ++i) sum += score({0.001 * i, 0, 0});
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(weigh_in_window)->Unit(benchmark::kMicrosecond);

void kalman_update(benchmark::State& state) {
  MapLandmark landmark;
  landmark.at = {8, 2};
  const SightingSet seen = sightings(1);
  PoseEstimate e{{}, Eigen::Matrix3d::Identity() * 0.1};
  for (auto _ : state) benchmark::DoNotOptimize(kalman_updated(e, seen.sightings[0], {}, landmark));
}
BENCHMARK(kalman_update);

void identify_eight(benchmark::State& state) {
  const LandmarkGrid map = map_of(50000);
  SightingSet seen = sightings(8);
  PoseEstimate robot{{}, Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal()};
  for (auto _ : state) benchmark::DoNotOptimize(identify(seen, robot, map, {}, {}).matches.size());
}
BENCHMARK(identify_eight)->Unit(benchmark::kMicrosecond);

void stems_of_a_scan(benchmark::State& state) {
  Random random(1, "scan");
  LaserScan scan{
      .robot_from_sensor = {}, .first_angle = -1.57, .angle_step = 0.0087, .ranges = {}, .most_range = 80};
  for (int i = 0; i < 361; ++i)
    scan.ranges.push_back(static_cast<float>(random.chance(0.7) ? 81.9 : random.uniform(3, 60)));
  for (auto _ : state) benchmark::DoNotOptimize(find_stems(scan, {}).size());
}
BENCHMARK(stems_of_a_scan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace waymark::testing

BENCHMARK_MAIN();
