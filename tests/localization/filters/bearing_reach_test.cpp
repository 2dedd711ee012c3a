// SPDX-License-Identifier: Apache-2.0
// Bearings are associated with landmarks within the reach of their type.
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/motion_model.hpp"

namespace waymark::test {
using namespace localization;
namespace {

const TypeRegistry& built_in_types() {
  static const TypeRegistry registry = [] {
    TypeRegistry types;
    register_landmark_types(types);
    return types;
  }();
  return registry;
}

MapLandmark landmark(LandmarkKey key, double x, double y, const char* type) {
  return {.key = key,
          .at = {x, y},
          .covariance = Eigen::Matrix2d::Identity() * 25,
          .type = built_in_types().id(type),
          .features = {}};
}

// Summits all around at 4 to 60 km, and rocks that are much nearer.
std::vector<MapLandmark> summits_and_rocks() {
  std::vector<MapLandmark> all = {
      landmark(1, 4000, 500, "mountain_top"), landmark(2, -3000, 6000, "mountain_top"),
      landmark(3, 2000, -9000, "mountain_top"), landmark(4, -60000, -5000, "mountain_top")};
  Random random(1, "rocks");
  for (LandmarkKey i = 0; i < 300; ++i)
    all.push_back(landmark(100 + i, random.uniform(-500, 500), random.uniform(-500, 500), "rock"));
  return all;
}

SightingSet bearings_of_summits(const Pose2& robot, Random& random) {
  SightingSet set;
  for (const MapLandmark& l : summits_and_rocks()) {
    if (l.type != built_in_types().id("mountain_top")) continue;
    const Eigen::Vector2d to = l.at - robot.at();
    set.sightings.push_back(
        {.type = l.type,
         .bearing = wrap_angle(std::atan2(to.y(), to.x()) - robot.yaw + 0.001 * random.normal()),
         .bearing_sd = 0.001,
         .range = {},
         .features = {},
         .identity = {}});
  }
  return set;
}

const PoseEstimate kStart{{40, -30, 0.03}, Eigen::Vector3d(2500, 2500, 0.0025).asDiagonal()};
// The default number of particles covers bearings of 1 mrad only where the pose is known roughly.
const PoseEstimate kParticleStart{{8, -6, 0.004}, Eigen::Vector3d(100, 100, 25e-6).asDiagonal()};

void expect_found_by_summits(Localizer& filter, const char* name) {
  const Pose2 robot{0, 0, 0};
  Random random(2, "bearings");
  int matched = 0;
  for (int i = 0; i < 20; ++i)
    for (const Match& match : filter.update(bearings_of_summits(robot, random)))
      matched += match.verdict == Verdict::matched;
  EXPECT_GE(matched, 60) << name;  // of 80
  // Twenty bearings of 1 mrad at 4 km and more: 2 m across the nearest, 0.5 mrad in yaw.
  EXPECT_LT(filter.estimate().pose.at().norm(), 15) << name;
  EXPECT_LT(std::abs(filter.estimate().pose.yaw), 0.003) << name;
}

TEST(BearingReach, FarSummitsLocalizeEveryFilter) {
  const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid(summits_and_rocks())},
                                FeatureScales(built_in_types()));
  ExtendedKalman ekf(kStart, matcher);
  expect_found_by_summits(ekf, "ekf");
  UnscentedKalman ukf(kStart, matcher);
  expect_found_by_summits(ukf, "ukf");
  MultiHypothesisFilter hypotheses(kStart, matcher);
  expect_found_by_summits(hypotheses, "hypotheses");
  ParticleFilter particles(kParticleStart, matcher);
  expect_found_by_summits(particles, "particles");
}

TEST(BearingReach, IsThatOfTheType) {
  const TypeRegistry& types = built_in_types();
  const FeatureScales scales(types);
  const IdentificationOptions options;
  for (const char* type : {"rock", "mountain_top"}) {
    const double reach = types[types.id(type)].identification_reach;
    for (const double range : {0.8 * reach, 1.5 * reach}) {
      MapLandmark exact = landmark(1, range, 0, type);
      exact.covariance *= 1e-3;  // an uncertain landmark is looked for farther away
      const LandmarkGrid map({exact});
      const SeenLandmark seen{
          .type = types.id(type), .bearing = 0, .range = {}, .features = {}, .identity = {}};
      const PoseEstimate robot{{}, Eigen::Matrix3d::Identity() * 1e-6};
      EXPECT_EQ(candidates(seen, {}, robot, map, scales, options).pairings.size(), range < reach ? 1u : 0u)
          << type << ' ' << range;
    }
  }
}

TEST(BearingReach, OptionReplacesTheReachOfTypes) {
  const FeatureScales scales(built_in_types());
  const SeenLandmark rock{.type = built_in_types().id("rock"), .range = {}, .features = {}, .identity = {}};
  EXPECT_EQ(IdentificationOptions{}.reach_of(rock, scales), 100);
  EXPECT_EQ((IdentificationOptions{.bearing_reach = 30}).reach_of(rock, scales), 30);
}

// A camera's range says how far the landmarks on a bearing may be; summits are seen beyond it.
TEST(BearingReach, ASensorWithoutRangesBoundsItForNearTypes) {
  const FeatureScales scales(built_in_types());
  const IdentificationOptions camera{.sensor_range = 25};
  const auto reach_of = [&](const char* type) {
    return camera.reach_of({.type = built_in_types().id(type), .range = {}, .features = {}, .identity = {}},
                           scales);
  };
  EXPECT_EQ(reach_of("rock"), 25);
  EXPECT_EQ(reach_of("crater"), 25);
  EXPECT_EQ(reach_of("mountain_top"), 150e3);
  EXPECT_EQ((IdentificationOptions{.bearing_reach = 30, .sensor_range = 25}).clutter_reach(), 30);
  EXPECT_EQ(camera.clutter_reach(), 25);
}

// A sighting of unknown type must not make every rock within sight of a summit a candidate.
TEST(BearingReach, WithoutATypeIsTheSmallest) {
  const FeatureScales scales(built_in_types());
  EXPECT_EQ(scales.identification_reach({}), 100);
  EXPECT_EQ(FeatureScales().identification_reach({}), 100);
}

// A camera among rocks, four fifths of them mapped: a bearing is matched with the right rock or with none.
TEST(Bearings, AreMatchedRightlyOrNotAtAll) {
  int matched = 0, right = 0, sightings = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed, "camera");
    std::vector<MapLandmark> rocks, map;
    for (LandmarkKey i = 1; i <= 60; ++i) {
      rocks.push_back(landmark(i, random.uniform(-10, 50), random.uniform(-20, 20), "rock"));
      if (!random.bernoulli(0.8)) continue;
      map.push_back(rocks.back());
      map.back().covariance = 0.01 * Eigen::Matrix2d::Identity();
      map.back().at += 0.1 * Eigen::Vector2d(random.normal(), random.normal());
    }
    IdentificationOptions options;
    options.use_identities = false, options.bearing_reach = 20;
    MultiHypothesisFilter filter(
        {{}, Eigen::Vector3d(0.04, 0.04, 4e-4).asDiagonal()},
        LandmarkMatcher(LandmarkWindow{LandmarkGrid(map)}, FeatureScales(built_in_types()), options));
    Pose2 truth;
    const OdometryNoise noise{.along_per_metre = 1e-3, .across_per_metre = 1e-3, .yaw_per_metre = 1e-4};
    for (int step = 0; step < 40; ++step) {
      const BodyMotion motion = twist_motion(0.5, 0, 0, 1, noise);
      const Eigen::Vector3d sd = motion.covariance.diagonal().cwiseSqrt();
      truth = truth * pose_of(motion.step.vector() + sd.cwiseProduct(Eigen::Vector3d(
                                                         random.normal(), random.normal(), random.normal())));
      filter.predict(motion);
      SightingSet seen;
      std::vector<LandmarkKey> keys;
      for (const MapLandmark& rock : rocks) {
        const Eigen::Vector2d to = rock.at - truth.at();
        if (to.norm() > 20 || to.norm() < 1 || !random.bernoulli(0.5)) continue;
        keys.push_back(rock.key);
        seen.sightings.push_back(
            {.type = rock.type,
             .bearing = wrap_angle(std::atan2(to.y(), to.x()) - truth.yaw + 0.005 * random.normal()),
             .bearing_sd = 0.005,
             .range = {},
             .features = {},
             .identity = {}});
      }
      const std::vector<Match> matches = filter.update(seen);
      for (std::size_t i = 0; i < matches.size(); ++i) {
        ++sightings;
        matched += matches[i].verdict == Verdict::matched;
        right += matches[i].verdict == Verdict::matched && matches[i].key == keys[i];
      }
    }
  }
  RecordProperty("matched", matched), RecordProperty("right", right), RecordProperty("sightings", sightings);
  EXPECT_GE(right, 0.9 * matched);
  EXPECT_GT(matched, 0.2 * sightings);
}

}  // namespace
}  // namespace waymark::test
