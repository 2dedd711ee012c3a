// SPDX-License-Identifier: Apache-2.0
// What errors that persist cost a localizer: a motion with an update of the pose, a fix, and sightings of
// landmarks not seen before. One thread.
#include "localization/persistent_errors.hpp"

#include <benchmark/benchmark.h>

#include "core/random.hpp"
#include "localization/independent_fraction.hpp"
#include "localization/motion_model.hpp"

namespace waymark::bench {
namespace {

using namespace localization;

constexpr OdometryDrift kDrift{
    .scale_sd = 0.03, .slip_sd = 0.03, .sideways_sd = 0.02, .yaw_rate_sd = 0.002, .curvature_sd = 0.003};
constexpr FrameErrors kFrames{.map_shift_sd = 0.5, .mount_sd = 0.1, .mount_yaw_sd = 0.02};

/// The localizer's estimate before and after an update by landmarks.
struct Update {
  PoseEstimate before, after;
};

Update update_at(const PoseEstimate& pose) {
  Update update{pose, pose};
  update.after.covariance *= 0.5;
  update.after.pose.x += 0.01;
  return update;
}

const PoseEstimate kStart{{}, Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal()};

void motion_and_update(benchmark::State& state) {
  PersistentErrors errors(kDrift, kFrames);
  const BodyMotion motion = twist_motion(0.5, 0, 0.01, 1, {});
  const Update update = update_at(kStart);
  for (auto _ : state) {
    benchmark::DoNotOptimize(errors.correct(kStart, motion, 1));
    errors.learn(update.before, update.after);
  }
}
BENCHMARK(motion_and_update);

void fix(benchmark::State& state) {
  PersistentErrors errors(kDrift, kFrames);
  const Update update = update_at(kStart);
  const GnssFix seen{{0.1, 0.1}, 1};
  for (auto _ : state) {
    benchmark::DoNotOptimize(errors.relative_to_map(seen, kStart));
    errors.learn(seen, update.before, update.after);
  }
}
BENCHMARK(fix);

/// Argument: whether the eight landmarks are new.
void independent_fraction(benchmark::State& state) {
  Random random(1, "landmarks");
  SightingSet seen;
  std::vector<Match> matches;
  for (LandmarkKey key = 0; key < 8; ++key) {
    Match match;
    match.verdict = Verdict::matched, match.key = key;
    match.at = {random.uniform(2, 12), random.uniform(-6, 6)};
    match.covariance = 0.25 * Eigen::Matrix2d::Identity();
    SeenLandmark sighting;
    sighting.range = match.at.norm(), sighting.range_sd = 0.05;
    sighting.bearing = std::atan2(match.at.y(), match.at.x());
    seen.sightings.push_back(sighting), matches.push_back(match);
  }
  IndependentFraction fraction;
  for (auto _ : state) {
    if (state.range(0))
      for (Match& match : matches) match.key += 8;
    fraction.learn(seen, matches, kStart);
  }
  state.SetItemsProcessed(state.iterations() * 8);
}
BENCHMARK(independent_fraction)->ArgName("new")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
