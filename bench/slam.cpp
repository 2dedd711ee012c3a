// SPDX-License-Identifier: Apache-2.0
// SLAM with increasing numbers of landmarks, and graphs with increasing numbers of poses. One thread.
#include <benchmark/benchmark.h>

#include "localization/filters/measurement.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/graph_solver.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::bench {
using namespace test;
namespace {

/// A set of sightings in a synthetic world with so many landmarks on 50 m by 50 m, about a tenth of them
/// seen.
void slam_set(benchmark::State& state) {
  MadeDrive drive(1, static_cast<std::size_t>(state.range(0)));
  localization::SlamOptions options;
  options.max_range = 12;
  options.nearest = 0.3;
  localization::EkfSlam slam({drive.truth(), Eigen::Matrix3d::Identity() * 1e-9}, options);
  for (int i = 0; i < 150; ++i) slam.predict(drive.drive()), slam.update(drive.look());
  for (auto _ : state) {
    state.PauseTiming();
    const localization::BodyMotion step = drive.drive();
    const localization::SightingSet seen = drive.look();
    state.ResumeTiming();
    slam.predict(step);
    benchmark::DoNotOptimize(slam.update(seen).size());
  }
  state.counters["landmarks"] = static_cast<double>(slam.landmarks().size());
}
BENCHMARK(slam_set)->Arg(30)->Arg(60)->Arg(200)->Unit(benchmark::kMicrosecond);

/// The state alone, per metre driven on a circle of 80 m: eight of the landmarks within 25 m are measured;
/// every 15 m the landmarks within 50 m become active. So many landmarks on 300 m by 300 m.
void slam_state(benchmark::State& state) {
  localization::SlamState slam({{0, -80, 0}, Eigen::Matrix3d::Identity() * 1e-6});
  for (const localization::MapLandmark& l :
       scatter_landmarks(static_cast<std::size_t>(state.range(0)), 300, 1, 0.2))
    slam.add(l.at, l.covariance);
  slam.focus(50);
  const localization::BodyMotion step{{1, 0, 1.0 / 80}, Eigen::Vector3d(1e-4, 1e-5, 1e-6).asDiagonal()};
  int driven = 0;
  for (auto _ : state) {
    slam.predict(step);
    if (++driven % 15 == 0) slam.focus(50);
    std::vector<localization::SlamState::Correction> corrections;
    for (const auto slot : slam.active()) {
      if (corrections.size() == 8 || (slam.at(slot) - slam.pose().at()).norm() > 25) continue;
      const localization::ExpectedSighting e = localization::expect(slam.pose(), {}, slam.at(slot));
      corrections.push_back({slot, Eigen::Vector2d::Zero(), e.by_pose, e.by_landmark,
                             Eigen::Vector2d(0.01, 1e-4).asDiagonal()});
    }
    slam.update(corrections);
  }
}
BENCHMARK(slam_state)->Arg(300)->Arg(1000)->Iterations(300)->Unit(benchmark::kMicrosecond);

localization::PoseGraph rounds(std::size_t poses) {
  Random random(1, "rounds");
  localization::PoseGraph graph;
  for (std::size_t i = 0; i < poses; ++i) {
    graph.poses.push_back({.id = static_cast<std::int64_t>(i), .at = {}});
    const localization::Pose2 step{0.5 + 0.01 * random.normal(), 0.005 * random.normal(),
                                   0.05 + 0.005 * random.normal()};
    const Eigen::Matrix3d root = Eigen::Vector3d(100, 200, 200).asDiagonal();
    if (i > 0) graph.steps.push_back({i - 1, i, step, root});
    constexpr std::size_t kRound = 126;  // poses
    if (i >= kRound && i % 10 == 0)
      graph.steps.push_back(
          {i - kRound, i, {0, 0, localization::wrap_angle(0.05 * kRound)}, Eigen::Matrix3d::Identity() * 20});
  }
  return graph;
}

void graph_from_odometry(benchmark::State& state) {
  const localization::PoseGraph graph = rounds(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(localization::optimise(graph).chi2);
}
BENCHMARK(graph_from_odometry)->Arg(500)->Arg(2000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
