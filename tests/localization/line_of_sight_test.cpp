// SPDX-License-Identifier: Apache-2.0
#include "localization/line_of_sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/sighting_score.hpp"
#include "made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

/// A wall of 3 m that runs north at x = 5 m, from y = 0 on.
std::optional<double> wall(const Eigen::Vector2d& p) {
  if (p.x() > 1000) return {};
  return std::abs(p.x() - 5) < 1 && p.y() > 0 ? 3 : 0;
}

TEST(LineOfSight, HillsHideAndUnknownTerrainDoesNot) {
  const LineOfSight sees = terrain_line_of_sight(wall, {});
  EXPECT_TRUE(sees({0, 3, 0}, {3, 3}));
  EXPECT_FALSE(sees({0, 3, 0}, {10, 3}));
  EXPECT_FALSE(sees({10, 3, 0}, {0, 3}));
  EXPECT_TRUE(sees({0, 3, 0}, {5, 3})) << "a landmark on the wall is visible";
  EXPECT_TRUE(sees({0, -3, 0}, {10, -3}));
  EXPECT_TRUE(sees({0, 3, 0}, {2000, 3}));
  EXPECT_TRUE(sees({0, 3, 0}, {0, 3}));
  EXPECT_TRUE(terrain_line_of_sight(wall, {.sensor_height = 10, .landmark_height = 10})({0, 3, 0}, {10, 3}));
  EXPECT_FALSE(terrain_line_of_sight({}, {}));
}

/// Hills of a random surface, 60 x 60 nodes 20 m apart.
Terrain hills(unsigned seed) {
  Random random(seed, "hills");
  Grid<float> heights(60, 60);
  for (float& h : heights.cells()) h = static_cast<float>(random.uniform(0, 12));
  return Terrain(std::move(heights), -600, 600, 20, 20);
}

TEST(LineOfSight, OnHeightsInMemoryIsTheSampledOne) {
  const LineOfSightOptions options{.sensor_height = 2, .landmark_height = 3, .step = 0.05};
  int hidden = 0, different = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Terrain terrain = hills(seed);
    const LineOfSight fast = terrain_line_of_sight(terrain, options, 0, 0);
    Random random(seed, "lines");
    for (int i = 0; i < 100; ++i) {
      const Pose2 sensor{random.uniform(-500, 500), random.uniform(-500, 500), 0};
      const Eigen::Vector2d landmark(random.uniform(-500, 500), random.uniform(-500, 500));
      const double distance = (landmark - sensor.at()).norm();
      if (distance < 30) continue;
      // The cell before the landmark does not hide it: the slow twin ends there.
      bool free = true;
      const double eye = *terrain.height(sensor.x, sensor.y) + 2,
                   top = *terrain.height(landmark.x(), landmark.y()) + 3;
      for (double t = options.step; t < distance - 20 && free; t += options.step) {
        const Eigen::Vector2d at = sensor.at() + (landmark - sensor.at()) * (t / distance);
        free = !(*terrain.height(at.x(), at.y()) > eye + (top - eye) * t / distance);
      }
      hidden += !free;
      different += fast(sensor, landmark) != free;
    }
  }
  EXPECT_GT(hidden, 300);
  EXPECT_LE(different, 2) << "a line that grazes a ridge between two samples";
}

TEST(LineOfSight, TheBodyCurvesAwayBelowLongLines) {
  // A plain: from 2 m the horizon is 5 km away, and 4 m are seen up to 12 km.
  const Terrain plain(Grid<float>(400, 3, 0.F), 0, 100, 100, 100);
  const LineOfSightOptions low{.sensor_height = 2, .landmark_height = 4, .step = 1};
  const auto sees = [&](double distance, double radius) {
    return terrain_line_of_sight(plain, low, radius, 0)({10, 0, 0}, {10 + distance, 0});
  };
  EXPECT_TRUE(sees(30000, 0));
  EXPECT_TRUE(sees(11500, 6371000));  // sqrt(2 R 2) + sqrt(2 R 4) = 12.19 km
  EXPECT_FALSE(sees(13000, 6371000));
}

TEST(LineOfSight, UnknownHeightsInMemoryHideNothing) {
  Grid<float> heights(20, 20, 0.F);
  for (std::int64_t r = 0; r < 20; ++r) heights(10, r) = std::numeric_limits<float>::quiet_NaN();
  const LineOfSight sees = terrain_line_of_sight(Terrain(heights, 0, 19, 1, 1), {}, 0, 0);
  EXPECT_TRUE(sees({2, 5, 0}, {18, 5}));
  EXPECT_TRUE(sees({-50, 5, 0}, {18, 5})) << "the sensor stands outside";
}

TEST(LineOfSight, HiddenLandmarksAreThoseOfASearchOfAll) {
  const auto all = scatter_landmarks(200, 40, 5);
  const LandmarkGrid map(all);
  const LineOfSight sees = terrain_line_of_sight(wall, {});
  const Pose2 sensor{-2, 4, 0.3};
  const auto hidden = hidden_landmarks(sensor, map, 15, sees);
  EXPECT_GT(hidden.size(), 3u);
  for (std::uint32_t i = 0; i < map.size(); ++i) {
    const bool near = (map[i].at - sensor.at()).norm() <= 15;
    EXPECT_EQ(std::ranges::binary_search(hidden, i), near && !sees(sensor, map[i].at)) << i;
  }
  EXPECT_TRUE(hidden_landmarks(sensor, map, 15, {}).empty());
}

TEST(LineOfSight, HiddenIsWhatNoProbablePositionSees) {
  const LineOfSight sees = terrain_line_of_sight(wall, {});
  const Eigen::Matrix2d sharp = Eigen::Matrix2d::Identity() * 1e-4;
  EXPECT_TRUE(is_hidden({0, 3, 0}, sharp, {10, 3}, sees));
  EXPECT_FALSE(is_hidden({0, 3, 0}, sharp, {3, 3}, sees));
  EXPECT_FALSE(is_hidden({0, 3, 0}, sharp, {10, 3}, {}));
  const Eigen::Matrix2d wide = (Eigen::Matrix2d() << 1e-4, 0, 0, 25).finished();
  EXPECT_FALSE(is_hidden({0, 3, 0}, wide, {10, -6}, sees)) << "from y = -7 it is seen";
  const Eigen::Matrix2d turned = (Eigen::Matrix2d() << 12.5, 12.5, 12.5, 12.5001).finished();
  EXPECT_FALSE(is_hidden({0, 3, 0}, turned, {10, -6}, sees)) << "from (-7, -4), along the axis";
}

TEST(LineOfSight, HiddenLandmarksAreNoCandidates) {
  // A bearing to the east from (0, 3): one landmark before the wall, two behind it.
  const LandmarkGrid map({landmark_at(3, 3, 1), landmark_at(9, 3, 2), landmark_at(12, 3.05, 3)});
  const PoseEstimate robot{{0, 3, 0}, Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()};
  SightingSet set;
  SeenLandmark seen;
  seen.type = map[0].type;
  seen.bearing = 0;
  seen.bearing_sd = 0.01;
  set.sightings = {seen};
  IdentificationOptions options;
  const auto landmarks = [&] {
    std::vector<LandmarkKey> keys;
    for (const CandidatePair& p : candidates(seen, {}, robot, map, {}, options).pairings)
      keys.push_back(map[p.landmark].key);
    std::ranges::sort(keys);
    return keys;
  };
  options.visible = terrain_line_of_sight(wall, {});
  EXPECT_EQ(landmarks(), (std::vector<LandmarkKey>{1, 2, 3})) << "unless asked for";
  EXPECT_EQ(identify(set, robot, map, {}, options).matches[0].verdict, Verdict::ambiguous);
  options.use_terrain = true;
  EXPECT_EQ(landmarks(), std::vector<LandmarkKey>{1});
  EXPECT_EQ(identify(set, robot, map, {}, options).matches[0].verdict, Verdict::matched);
  options.visible = {};
  EXPECT_EQ(landmarks().size(), 3u) << "without a DEM nothing is hidden";
}

// A landmark 3 m ahead: the one at x = 3 seen from x = 0, or the one at x = 5 seen from x = 2. From there a
// third one behind the wall would be in view.
double x_of_estimate(const LineOfSight& visible) {
  std::vector<MapLandmark> all{landmark_at(3, -2, 1), landmark_at(5, -2, 2), landmark_at(9, 5, 3)};
  for (MapLandmark& l : all) l.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  WeightOptions view;
  view.expect_unseen = true;
  view.detection = 0.95;
  view.view_range = 11;
  MultiHypothesisFilter filter({{1, -2, 0}, Eigen::Vector3d(1, 1e-4, 1e-6).asDiagonal()},
                               LandmarkMatcher(LandmarkWindow{LandmarkGrid(all)}));
  filter.expect_landmarks(view, visible);
  filter.update({{}, {seen_at(3, 0)}});
  return filter.estimate().pose.x;
}

TEST(LineOfSight, HiddenLandmarksAreNotExpectedByTheMixture) {
  EXPECT_NEAR(x_of_estimate({}), 0, 0.2) << "the unseen landmark counts against x = 2";
  EXPECT_GT(x_of_estimate(terrain_line_of_sight(wall, {})), 0.5) << "both are possible, or all but so";
}

TEST(LineOfSight, HiddenLandmarksAreNotExpectedByParticles) {
  std::vector<MapLandmark> all{landmark_at(3, 4, 1), landmark_at(9, 5, 2)};
  const LandmarkGrid map(all);
  WeightOptions view;
  view.expect_unseen = true;
  const SightingSet seen{{}, {seen_at(3, 0)}};
  const FeatureScales scales;
  SightingScore score(seen, map, scales, view, {});
  const double expects = score({0, 4, 0});
  score.hide(hidden_landmarks({0, 4, 0}, map, 20, terrain_line_of_sight(wall, {})));
  EXPECT_NEAR(score({0, 4, 0}) - expects, -view.temper * std::log1p(-view.detection), 1e-9);
}

// Slow twin: all beams are compared, each by its own direction.
TEST(RangeProfile, ReachesWhatNoBeamEndsBefore) {
  int hidden = 0, free = 0, outside = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Random random(seed, "beams");
    RangeProfile scan{
        random.uniform(-3, 3), random.uniform(0.01, 0.1) * (random.bernoulli(0.5) ? 1 : -1), {}};
    const std::size_t beams = 2 + random.uniform_index(50);
    for (std::size_t i = 0; i < beams; ++i)
      scan.ranges.push_back(random.bernoulli(0.1)   ? 0
                            : random.bernoulli(0.1) ? std::numeric_limits<float>::quiet_NaN()
                                                    : static_cast<float>(random.uniform(1, 20)));
    const double bearing = random.uniform(-3.1, 3.1), width = random.uniform(0.06, 0.3),
                 range = random.uniform(0.5, 12), half = std::abs(scan.angle_step) / 2;
    bool reaches = true, left = false, right = false;
    for (std::size_t i = 0; i < beams; ++i) {
      const double beam = scan.first_angle + scan.angle_step * static_cast<double>(i);
      left = left || std::abs(wrap_angle(beam - bearing - width)) <= half;
      right = right || std::abs(wrap_angle(beam - bearing + width)) <= half;
      if (std::abs(wrap_angle(beam - bearing)) <= width && scan.ranges[i] > 0 &&
          double(scan.ranges[i]) < range)
        reaches = false;
    }
    const bool covered = left && right;  // what a scan leaves open is wider than any of these views
    ASSERT_EQ(scan.reaches(bearing, width, range), covered && reaches) << "seed " << seed;
    ++(!covered ? outside : reaches ? free : hidden);
  }
  EXPECT_GT(hidden, 200);
  EXPECT_GT(free, 50);
  EXPECT_GT(outside, 200);
}

TEST(RangeProfile, TakesTheNearestBeamAndAnEmptyScanReachesNothing) {
  const RangeProfile scan{-1, 0.5, {9, 9, 3, 9, 9}};
  EXPECT_FALSE(scan.reaches(0.2, 0, 4));
  EXPECT_TRUE(scan.reaches(0.3, 0, 4));
  EXPECT_TRUE(scan.reaches(0.2, 0, 3));
  EXPECT_FALSE(RangeProfile{}.reaches(0, 0, 1));
}

}  // namespace
}  // namespace waymark::test
