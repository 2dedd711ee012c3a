// SPDX-License-Identifier: Apache-2.0
// Updates of the filters: particles times sightings on maps of 1e3 to 1e7 landmarks at one density, a
// particle filter's whole update, and Kalman updates. One thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <numbers>

#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"
#include "localization/detectors/laser_stems.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/filters/sighting_score.hpp"
#include "localization/global/constellation.hpp"
#include "localization/identification/landmark_window.hpp"
#include "tests/localization/made_look.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::bench {
using namespace test;
namespace {

constexpr double kDensity = 0.02;  // landmarks per square metre

localization::SightingSet sightings(std::size_t count) {
  Random random(1, "sightings");
  localization::SightingSet set;
  for (std::size_t i = 0; i < count; ++i) {
    localization::SeenLandmark s;
    s.type = TypeId{0};
    s.range = random.uniform(3, 20);
    s.bearing = random.uniform(-1.5, 1.5);
    s.features.value[0] = random.uniform(0.2, 1);
    s.features.variance[0] = 0.01;
    set.sightings.push_back(s);
  }
  return set;
}

/// `vague`: one landmark in twenty is known to 2 m only, as those that few images show.
localization::LandmarkGrid map_of(std::size_t landmarks, bool vague = false) {
  auto all = scatter_landmarks(landmarks, std::sqrt(static_cast<double>(landmarks) / kDensity), 1);
  Random random(1, "features");
  for (localization::MapLandmark& l : all) l.features.value[0] = random.uniform(0.2, 1);
  if (vague)
    for (std::size_t i = 0; i < all.size(); i += 20) all[i].covariance = 4 * Eigen::Matrix2d::Identity();
  return localization::LandmarkGrid(std::move(all));
}

/// A tenth of the landmarks is doubtful, or none: their neighbours decide whether they are left out.
void build_grid(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  auto all = scatter_landmarks(count, std::sqrt(static_cast<double>(count) / kDensity), 1);
  if (state.range(1) != 0)
    for (std::size_t i = 0; i < all.size(); i += 10) all[i].quality = 0.3;
  for (auto _ : state) benchmark::DoNotOptimize(localization::LandmarkGrid(all));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(build_grid)->Args({50000, 0})->Args({50000, 1})->Unit(benchmark::kMillisecond);

/// Likelihoods of particles within a metre of each other, features compared.
void weight(benchmark::State& state) {
  const localization::LandmarkGrid map = map_of(static_cast<std::size_t>(state.range(0)));
  const auto particles = static_cast<std::size_t>(state.range(1));
  const localization::SightingSet seen = sightings(static_cast<std::size_t>(state.range(2)));
  Random random(1, "particles");
  std::vector<localization::Pose2> poses(particles);
  for (localization::Pose2& p : poses) p = {random.normal(), random.normal(), 0.1 * random.normal()};
  const localization::FeatureScales scales;
  std::vector<double> fit(particles);
  for (auto _ : state) {
    localization::SightingScore score(seen, map, scales, {}, {.use_identities = false});
    score.prefetch(poses);
    score(poses, fit);
    benchmark::DoNotOptimize(fit.data());
    benchmark::ClobberMemory();
  }
  state.counters["evaluations/s"] = benchmark::Counter(
      static_cast<double>(particles * seen.sightings.size()) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
}
BENCHMARK(weight)
    ->ArgNames({"landmarks", "particles", "sightings"})
    ->Args({1000, 1000, 8})
    ->Args({100000, 1000, 8})
    ->Args({1000000, 1000, 8})
    ->Args({10000000, 1000, 8})
    ->Args({50000, 1000, 3})
    ->Unit(benchmark::kMicrosecond);

/// Sightings of a robot that drives in a circle, one set every 0.5 m, three landmarks of `map` each, with
/// errors as stated.
std::vector<localization::SightingSet> round_trip_sightings(const localization::LandmarkGrid& map,
                                                            std::size_t count, bool ranges) {
  Random random(1, "looks");
  std::vector<localization::SightingSet> looks(count);
  localization::Pose2 robot;
  const localization::Pose2 step =
      localization::twist_motion(0.5, 0, 2 * std::numbers::pi / static_cast<double>(count), 1, {}).step;
  for (localization::SightingSet& look : looks) {
    robot = robot * step;
    std::vector<std::uint32_t> near;
    map.near(robot.at(), 20, [&](std::uint32_t i) { near.push_back(i); });
    for (int i = 0; i < 3 && !near.empty(); ++i) {
      const auto chosen = near.begin() + static_cast<std::ptrdiff_t>(random.uniform_index(near.size()));
      const localization::MapLandmark& l = map[*chosen];
      near.erase(chosen);
      const Eigen::Vector2d to = l.at - robot.at();
      localization::SeenLandmark s;
      s.type = l.type;
      s.bearing =
          localization::wrap_angle(std::atan2(to.y(), to.x()) - robot.yaw + s.bearing_sd * random.normal());
      if (ranges) s.range = std::max(to.norm() + s.range_sd * random.normal(), 0.1);
      s.features.value[0] = l.features.value[0] + 0.1 * random.normal();
      s.features.variance[0] = 0.01;
      look.sightings.push_back(s);
    }
  }
  return looks;
}

/// The particle filter's whole update, motion and sightings without identities: 1000 particles, three
/// sightings, 50,000 landmarks in memory. `error_m`: mean, so that a filter that is lost shows.
void particle_update(benchmark::State& state) {
  const localization::LandmarkGrid map = map_of(50000, state.range(1) != 0);
  const std::vector<localization::SightingSet> looks = round_trip_sightings(map, 200, state.range(0) != 0);
  const localization::BodyMotion step = localization::twist_motion(0.5, 0, 2 * std::numbers::pi / 200, 1, {});
  localization::PoseEstimate start;
  start.covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal();
  localization::ParticleOptions options;
  options.particles = 1000;
  options.threads = 1;
  localization::ParticleFilter filter(
      start, localization::LandmarkMatcher(localization::LandmarkWindow(map), {}, {.use_identities = false}),
      options);
  localization::Pose2 truth;
  double error = 0;
  std::size_t updates = 0;
  for (auto _ : state) {
    truth = truth * step.step;
    filter.predict(step);
    benchmark::DoNotOptimize(filter.update(looks[updates++ % looks.size()]).size());
    error += (filter.estimate().pose.at() - truth.at()).norm();
  }
  state.counters["error_m"] = error / static_cast<double>(updates);
}
BENCHMARK(particle_update)
    ->ArgNames({"ranges", "vague"})
    ->Args({1, 0})
    ->Args({1, 1})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(particle_update)->ArgNames({"ranges", "vague"})->Args({0, 0})->Unit(benchmark::kMillisecond);

/// Cost of the update in a cached window of 200 m, which does not depend on the size of the map.
void weight_in_window(benchmark::State& state) {
  localization::LandmarkWindow window(
      [](const Eigen::AlignedBox2d& box) {
        return scatter_landmarks(static_cast<std::size_t>(kDensity * box.volume()), box.sizes().x(), 1);
      },
      100);
  const localization::SightingSet seen = sightings(8);
  const localization::FeatureScales scales;
  double sum = 0;
  for (auto _ : state) {
    const localization::SightingScore score(seen, window.landmarks_near({0, 0}, 30), scales, {},
                                            {.use_identities = false});
    for (int i = 0; i < 1000; ++i) sum += score({0.001 * i, 0, 0});
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(weight_in_window)->Unit(benchmark::kMicrosecond);

/// A map file of rocks at the density above, made once; removed at the end.
struct MapFile {
  explicit MapFile(std::int64_t count)
      : path(std::filesystem::temp_directory_path() / ("waymark_windows_" + std::to_string(count) + ".gpkg")),
        side(std::sqrt(static_cast<double>(count) / kDensity)) {
    geodb::MapContents map;
    LandmarkType type;
    type.name = "rock";
    type.features = {{"radius", "m", Scale::ratio, 0.01, 100, ""},
                     {"height", "m", Scale::ratio, 0.01, 100, ""}};
    map.types.add(type);
    Random random(1, "map file");
    map.landmarks.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
      Landmark& l = map.landmarks[i];
      l.uid = "r" + std::to_string(i);
      l.position.xyz = {random.uniform(0, side), random.uniform(0, side), 0};
      l.covariance = Eigen::Matrix3d::Identity() * 0.01;
      l.features = {{random.uniform(0.2, 1), 0.01, 3}, {random.uniform(0.2, 1), 0.01, 3}};
      l.quality = {.seen = 3, .visible = 4, .feature_confidences = {0.9, 0.9}};
      l.observations = 3;
    }
    geodb::write_map(path, map);
  }
  ~MapFile() { std::filesystem::remove(path); }
  std::filesystem::path path;
  double side;
};

/// A robot at a random position: reads 70 m x 70 m of the map from the file into a grid, uncached. The
/// median and the 99th percentile of the times are counters, microseconds.
void cold_window(benchmark::State& state) {
  const MapFile file(state.range(0));
  const geodb::MapStore store = geodb::MapStore::open(file.path);
  const LocalFrame frame(store.crs(), {});
  Random random(1, "places");
  std::vector<double> times;
  std::size_t landmarks = 0;
  const double side = 70 + 2 * localization::kOutweighedRadius;  // m
  for (auto _ : state) {
    const double x = random.uniform(0, file.side - side), y = random.uniform(0, file.side - side);
    const auto begun = std::chrono::steady_clock::now();
    std::vector<localization::MapLandmark> all;
    for (const Landmark& l : store.query({.box = geodb::MapQuery::Box{x, y, x + side, y + side}}))
      all.push_back(localization::map_landmark(l, store.types()[l.type], frame));
    const localization::LandmarkGrid grid(std::move(all));
    landmarks += grid.size();
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begun).count());
  }
  std::ranges::sort(times);
  state.counters["median_us"] = times[times.size() / 2];
  state.counters["p99_us"] = times[times.size() * 99 / 100];
  state.counters["landmarks"] = static_cast<double>(landmarks) / static_cast<double>(times.size());
}
BENCHMARK(cold_window)
    ->Arg(100000)
    ->Arg(1000000)
    ->Arg(10000000)
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);

/// Global localization in the whole map: 15 rocks with radii, 10 % wrong, 70 % of those in range.
void constellation(benchmark::State& state) {
  auto map = scatter_landmarks(static_cast<std::size_t>(state.range(0)),
                               std::sqrt(static_cast<double>(state.range(0)) / kDensity), 1, 0.05);
  Random random(1, "radius");
  std::vector<localization::LandmarkPosition> places;
  for (localization::MapLandmark& l : map) {
    l.features.value[0] = random.log_uniform(0.2, 1);
    places.push_back({{l.at.x(), l.at.y(), 0}, Eigen::Vector3d::UnitZ()});
  }
  const localization::ConstellationIndex index(map, localization::FeatureScales{});
  std::vector<localization::SightingSet> sets;
  for (int i = 0; i < 20; ++i)
    sets.push_back(look(map, places, {.origin = places[random.uniform_index(places.size())].at}, {},
                        {.reach = 18}, random)
                       .set);
  std::size_t found = 0, tries = 0;
  for (auto _ : state) found += index.find(sets[tries++ % sets.size()]).fix.has_value();
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(tries);
  state.counters["bytes/landmark"] = static_cast<double>(index.bytes()) / static_cast<double>(index.size());
}
BENCHMARK(constellation)->Arg(1000)->Arg(30000)->Arg(300000)->Unit(benchmark::kMillisecond);

/// Search within a prior of some metres and degrees, in a map of a fifth of the objects. Argument: sd, m.
void constellation_near(benchmark::State& state) {
  Random random(4, "near");
  std::vector<localization::MapLandmark> objects = scatter_landmarks(5000, 500, 3, 0.05), mapped;
  std::vector<localization::LandmarkPosition> places;
  for (localization::MapLandmark& l : objects) {
    l.features.value[0] = random.log_uniform(0.2, 1);
    places.push_back({{l.at.x(), l.at.y(), 0}, Eigen::Vector3d::UnitZ()});
    if (random.bernoulli(0.2)) mapped.push_back(l);
  }
  const localization::ConstellationIndex index(mapped, localization::FeatureScales{});
  const auto sd = static_cast<double>(state.range(0));
  localization::PoseEstimate prior;
  prior.covariance = Eigen::Vector3d(sd * sd, sd * sd, 0.01).asDiagonal();
  std::vector<localization::SightingSet> sets;
  for (int i = 0; i < 20; ++i)
    sets.push_back(look(objects, places, {}, prior.pose, {.reach = 25}, random).set);
  std::size_t found = 0, tries = 0;
  for (auto _ : state) found += index.find_near(sets[tries++ % sets.size()], prior).fix.has_value();
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(tries);
}
BENCHMARK(constellation_near)->Arg(1)->Arg(3)->Arg(10)->Unit(benchmark::kMillisecond);

void kalman_update(benchmark::State& state) {
  localization::MapLandmark landmark;
  landmark.at = {8, 2};
  const localization::SightingSet seen = sightings(1);
  localization::PoseEstimate e{{}, Eigen::Matrix3d::Identity() * 0.1};
  for (auto _ : state) benchmark::DoNotOptimize(localization::ekf_update(e, seen.sightings[0], {}, landmark));
}
BENCHMARK(kalman_update);

void identify_eight(benchmark::State& state) {
  const localization::LandmarkGrid map = map_of(50000);
  localization::SightingSet seen = sightings(8);
  localization::PoseEstimate robot{{}, Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal()};
  for (auto _ : state)
    benchmark::DoNotOptimize(localization::identify(seen, robot, map, {}, {}).matches.size());
}
BENCHMARK(identify_eight)->Unit(benchmark::kMicrosecond);

void stems_in_scan(benchmark::State& state) {
  Random random(1, "scan");
  localization::LaserScan scan{
      .robot_from_sensor = {}, .first_angle = -1.57, .angle_step = 0.0087, .ranges = {}, .max_range = 80};
  for (int i = 0; i < 361; ++i)
    scan.ranges.push_back(static_cast<float>(random.bernoulli(0.7) ? 81.9 : random.uniform(3, 60)));
  for (auto _ : state) benchmark::DoNotOptimize(localization::find_stems(scan, {}).size());
}
BENCHMARK(stems_in_scan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
