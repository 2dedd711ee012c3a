// SPDX-License-Identifier: Apache-2.0
// Maps that lack most of what a robot sees, and maps with landmarks that do not exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>

#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using MakeOfMap = std::function<std::unique_ptr<Localizer>(const PoseEstimate&, const LandmarkMatcher&)>;
using MakeMap = std::function<std::vector<MapLandmark>(const std::vector<MapLandmark>&, std::uint64_t seed)>;

constexpr int kDrives = 8;

std::unique_ptr<Localizer> gaussians(const PoseEstimate& start, const LandmarkMatcher& matcher) {
  return std::make_unique<MultiHypothesisFilter>(start, matcher);
}
std::unique_ptr<Localizer> particles(const PoseEstimate& start, const LandmarkMatcher& matcher) {
  return std::make_unique<ParticleFilter>(start, matcher, ParticleOptions{.threads = 1, .weight = {}});
}
std::unique_ptr<Localizer> one_gaussian(const PoseEstimate& start, const LandmarkMatcher& matcher) {
  return std::make_unique<ExtendedKalman>(start, matcher);
}
std::unique_ptr<Localizer> odometry(const PoseEstimate& start, const LandmarkMatcher&) {
  return std::make_unique<DeadReckoning>(start);
}

std::vector<std::pair<const char*, MakeOfMap>> all_filters() {
  return {{"gaussians", gaussians}, {"particles", particles}, {"one gaussian", one_gaussian}};
}

/// Returns the RMSE, m, of each of eight drives among 200 objects, sorted. Identities are unknown.
std::vector<double> errors(const MakeOfMap& make, const MakeMap& make_map,
                           IdentificationOptions options = {}) {
  options.use_identities = false;
  std::vector<double> all;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    MadeDrive drive(seed, 200);
    const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid(make_map(drive.map(), seed))}, {}, options);
    const auto filter = make(drive.start(), matcher);
    double squares = 0;
    constexpr int kSteps = 80;
    for (int i = 0; i < kSteps; ++i) {
      filter->predict(drive.drive());
      filter->update(drive.look());
      squares += (filter->estimate().pose.at() - drive.truth().at()).squaredNorm() / kSteps;
    }
    all.push_back(std::sqrt(squares));
  }
  std::ranges::sort(all);
  return all;
}

std::vector<MapLandmark> whole(const std::vector<MapLandmark>& real, std::uint64_t) {
  return real;
}

/// Returns a map of a fraction of the objects.
MakeMap thinned(double fraction) {
  return [fraction](std::vector<MapLandmark> real, std::uint64_t seed) {
    Random random(seed, "thinned");
    std::erase_if(real, [&](const MapLandmark&) { return !random.bernoulli(fraction); });
    return real;
  };
}

/// Returns a map with three doubtful landmarks around each real one.
std::vector<MapLandmark> with_doubtful(const std::vector<MapLandmark>& real, std::uint64_t seed) {
  Random random(seed, "doubtful");
  std::vector<MapLandmark> all = real;
  for (MapLandmark& l : all) l.quality = 0.95;
  for (const MapLandmark& l : real)
    for (int i = 0; i < 3; ++i) {
      MapLandmark& wrong = all.emplace_back(l);
      wrong.key = 1000 + all.size();
      const double away = random.uniform(0.5, 3), along = random.uniform(-3.14, 3.14);
      wrong.at += away * Eigen::Vector2d(std::cos(along), std::sin(along));
      wrong.quality = random.uniform(0.1, 0.3);
    }
  return all;
}

TEST(SparseMap, FiltersWithAFewMappedObjectsAreBetterThanOdometry) {
  for (const double fraction : {0.6, 0.4, 0.15}) {
    // With 15 % mapped, one drive of eight follows an unmapped object farther than odometry errs
    // (docs/methods/unmapped_objects.md).
    const bool sparse = fraction < 0.2;
    const std::vector<double> by_odometry = errors(odometry, thinned(fraction));
    for (const auto& [name, make] : all_filters()) {
      const std::vector<double> found = errors(make, thinned(fraction));
      std::printf("%.2f mapped, %s: median %.3f, worst %.3f m; odometry %.3f, %.3f m\n", fraction, name,
                  found[kDrives / 2], found.back(), by_odometry[kDrives / 2], by_odometry.back());
      EXPECT_LT(found[kDrives / 2], 0.5 * by_odometry[kDrives / 2]) << name << fraction;
      if (!sparse) {
        EXPECT_LT(found.back(), by_odometry.back()) << name << fraction;
      }
    }
  }
}

TEST(SparseMap, DoubtfulLandmarksAreNoWorseThanNone) {
  for (const auto& [name, make] : all_filters()) {
    const std::vector<double> without = errors(make, whole), with = errors(make, with_doubtful);
    std::printf("%s: median %.3f, worst %.3f m without doubtful landmarks; %.3f, %.3f m with them\n", name,
                without[kDrives / 2], without.back(), with[kDrives / 2], with.back());
    // A tenth of the error of a single sighting, 0.1 m, is the tolerance for other choices of hypotheses.
    EXPECT_LT(with[kDrives / 2], without[kDrives / 2] + 0.01) << name;
    EXPECT_LT(with.back(), without.back() + 0.05) << name;
  }
}

TEST(ClutterEstimate, IsTheDensityOfSightingsWithoutLandmark) {
  Random random(4, "clutter");
  ClutterEstimate estimate;
  EXPECT_EQ(estimate.density(100), 0);
  for (int set = 0; set < 200; ++set) {
    SightingSet seen;
    for (int i = 0; i < 6; ++i)
      seen.sightings.push_back(seen_at(random.uniform(0.1, 12), random.uniform(-1.5, 1.5)));
    estimate.add_sightings(seen);
    if (set == 0) {  // half of six, over the view of a handful of sightings
      EXPECT_GT(estimate.density(100), 0.03);
      EXPECT_LT(estimate.density(100), 0.3);
    }
    estimate.add_unmapped(1.5, 6);
  }
  EXPECT_NEAR(estimate.density(100), 1.5 / (12 * 3),
              0.003);  // 300 sightings count: 4 % of each second moment
  ClutterEstimate bearings;
  SightingSet seen;
  for (const double bearing : {0.5, -0.5}) {
    seen.sightings.push_back(seen_at(5, bearing));
    seen.sightings.back().range.reset();
  }
  for (int set = 0; set < 200; ++set) bearings.add_sightings(seen), bearings.add_unmapped(1, 2);
  EXPECT_NEAR(bearings.density(100), 1 / (100 * std::sqrt(3.0)), 1e-4);  // a view of 2 sqrt(3) 0.5 rad
  ClutterEstimate ranges;
  for (SeenLandmark& s : seen.sightings) s.range = 5, s.bearing.reset();
  for (int set = 0; set < 200; ++set) ranges.add_sightings(seen), ranges.add_unmapped(1, 2);
  EXPECT_NEAR(ranges.density(100), 1 / (5 * std::sqrt(3.0) * 2 * std::numbers::pi), 1e-4);  // a full turn
}

// Terrain hides nine of ten landmarks. One that is in view by chance then fits ten times too easily.
TEST(LandmarkMatcher, ClutterCountsAgainstTheRateOfDetection) {
  constexpr double kRange = 12;
  const std::vector<MapLandmark> map = scatter_landmarks(900, 60, 3);
  const auto clutter = [&](double detection) {
    IdentificationOptions options;
    options.use_identities = false;
    LandmarkMatcher matcher(LandmarkWindow(LandmarkGrid(map)), {}, options);
    Random random(7, "hidden");
    for (int set = 0; set < 300; ++set) {
      SightingSet seen;
      std::vector<Match> matches;
      for (const MapLandmark& l : map) {
        const double range = l.at.norm(), bearing = std::atan2(l.at.y(), l.at.x());
        if (range > kRange || std::abs(bearing) > 1 || !random.bernoulli(detection)) continue;
        seen.sightings.push_back(seen_at(range, bearing));
        matches.push_back({.verdict = Verdict::matched, .pairing = {}, .unmapped = 0});
      }
      seen.sightings.push_back(seen_at(random.uniform(0.1, kRange), random.uniform(-1, 1)));
      matches.push_back({.verdict = Verdict::too_far, .pairing = {}});
      matcher.observe(seen);
      matcher.learn(matches, seen, {}, matcher.landmarks_near(seen, {}));
    }
    return matcher.options().clutter;
  };
  const double all = clutter(1), few = clutter(0.1);
  EXPECT_NEAR(all, 1 / (kRange * 2), 0.4 * all);  // one in the view
  EXPECT_NEAR(few / all, 10, 3);
}

}  // namespace
}  // namespace waymark::test
