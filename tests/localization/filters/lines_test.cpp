// SPDX-License-Identifier: Apache-2.0
// Walls and kerbs: lines that are known across themselves only.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "tests/localization/made_types.hpp"
#include "tests/localization/made_world.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

MapLandmark line_at(LandmarkKey key, double x, double y, double azimuth, double length) {
  MapLandmark line;
  line.key = key;
  line.at = {x, y};
  line.normal = {std::sin(azimuth), std::cos(azimuth)};
  line.half_length = length / 2;
  line.covariance = 1e-4 * line.normal * line.normal.transpose() +
                    length * length / 12 * line.along() * line.along().transpose();
  line.features.value[0] = azimuth;
  line.features.value[1] = length;
  return line;
}

/// Returns what a robot sees of the piece of a line from `from` to `to`, m from its middle.
SeenLandmark line_sighting_at(const MapLandmark& line, const Pose2& robot, double from, double to) {
  SeenLandmark s;
  s.type = TypeId{0};
  s.range = line.normal.dot(robot.at() - line.at);
  s.range_sd = 0.03;
  const double middle = line.along().dot(line.at - robot.at());
  s.extent = {middle + from, middle + to};
  s.features.value[0] = wrap_angle(kRightAngle - line.features.value[0] - robot.yaw);
  s.features.variance[0] = 1e-4;
  return s;
}

PoseEstimate near_pose(const Pose2& pose) {
  return {pose, Eigen::Vector3d(0.09, 0.09, 0.01).asDiagonal()};
}

RC_GTEST_PROP(Lines, DerivativesAreThoseOfTheMeasurement, ()) {
  const auto any = [](int limit) { return 0.01 * *rc::gen::inRange(-limit, limit); };
  const MapLandmark line = line_at(1, any(900), any(900), any(314), 8);
  const Pose2 robot{any(900), any(900), any(314)}, mount{any(100), any(100), any(314)};
  const SeenLandmark s = line_sighting_at(line, robot, -1, 1);
  const ExpectedSighting e = expect(robot, mount, s, line);
  constexpr double h = 1e-6;
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector3d moved = robot.vector();
    moved[k] += h;
    const double slope = (expect(pose_of(moved), mount, s, line).value[0] - e.value[0]) / h;
    RC_ASSERT(std::abs(slope - e.by_pose(0, k)) < 1e-4);
  }
  for (int k = 0; k < 2; ++k) {
    MapLandmark moved = line;
    moved.at[k] += h;
    RC_ASSERT(std::abs((expect(robot, mount, s, moved).value[0] - e.value[0]) / h - e.by_landmark(0, k)) <
              1e-4);
  }
}

// A wall in the north: y and yaw are measured, x is not, wherever along the wall its piece lies.
TEST(Lines, SayNothingAlongThemselves) {
  const FeatureScales scales(edges());
  const MapLandmark wall = line_at(1, 4, 8, std::numbers::pi, 30);
  const Pose2 truth{1, 2, 0.3}, guess{1.2, 1.8, 0.35};
  const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid({wall})}, scales);
  const auto follow = [&](auto&& filter) {
    for (int i = 0; i < 20; ++i) {
      const auto matches = filter.update({{}, {line_sighting_at(wall, truth, -9 + 0.5 * i, -4 + 0.5 * i)}});
      EXPECT_EQ(matches.at(0).verdict, Verdict::matched);
      EXPECT_EQ(matches.at(0).key, 1U);
    }
    return filter.estimate();
  };
  for (const PoseEstimate& after :
       {follow(ExtendedKalman(near_pose(guess), matcher)), follow(UnscentedKalman(near_pose(guess), matcher)),
        follow(MultiHypothesisFilter(near_pose(guess), matcher))}) {
    EXPECT_NEAR(after.pose.y, 2, 0.03);
    EXPECT_NEAR(wrap_angle(after.pose.yaw - 0.3), 0, 0.02);
    EXPECT_NEAR(after.pose.x, 1.2, 0.02);
    EXPECT_NEAR(std::sqrt(after.covariance(0, 0)), 0.3, 0.02);
    EXPECT_LT(std::sqrt(after.covariance(1, 1)), 0.03);
  }
  ParticleOptions options;
  options.particles = 2000;
  ParticleFilter particles(near_pose(guess), matcher, options);
  for (int i = 0; i < 5; ++i) particles.update({{}, {line_sighting_at(wall, truth, -3, 3)}});
  EXPECT_NEAR(particles.estimate().pose.y, 2, 0.05);
  EXPECT_NEAR(wrap_angle(particles.estimate().pose.yaw - 0.3), 0, 0.04);
  EXPECT_NEAR(std::sqrt(particles.estimate().covariance(0, 0)), 0.3, 0.1);
}

TEST(Lines, OfTwoWallsFixThePose) {
  const FeatureScales scales(edges());
  const MapLandmark north = line_at(1, 4, 8, std::numbers::pi, 30),
                    east = line_at(2, 12, 0, -kRightAngle, 20);
  const Pose2 truth{1, 2, 0.3};
  ExtendedKalman filter(near_pose({1.2, 1.8, 0.35}),
                        LandmarkMatcher(LandmarkWindow{LandmarkGrid({north, east})}, scales));
  for (int i = 0; i < 5; ++i)
    filter.update({{}, {line_sighting_at(north, truth, -2, 2), line_sighting_at(east, truth, -5, 3)}});
  EXPECT_LT((filter.estimate().pose.at() - truth.at()).norm(), 0.03);
}

// Two pieces of one wall in the map: which of them is seen does not matter, so the sighting counts.
TEST(Lines, OfOneWallInPiecesAreCertain) {
  const FeatureScales scales(edges());
  const std::vector<MapLandmark> pieces{line_at(1, -3, 8, std::numbers::pi, 10),
                                        line_at(2, 4, 8, std::numbers::pi, 10)};
  const Pose2 truth{1, 2, 0.3};
  const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid(pieces)}, scales);
  const SightingSet seen{{}, {line_sighting_at(pieces[0], truth, 0, 6)}};
  MultiHypothesisFilter mixture(near_pose({1.1, 1.9, 0.32}), matcher);
  ExtendedKalman single(near_pose({1.1, 1.9, 0.32}), matcher);
  EXPECT_LT(matcher.identify(seen, mixture.estimate(), LandmarkGrid(pieces)).matches.at(0).probability, 0.9);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(mixture.update(seen).at(0).verdict, Verdict::matched) << i;
    EXPECT_EQ(single.update(seen).at(0).verdict, Verdict::matched) << i;
  }
  EXPECT_NEAR(mixture.estimate().pose.y, 2, 0.03);
  EXPECT_NEAR(single.estimate().pose.y, 2, 0.03);
}

// Facades of one line: the piece that is seen decides which it is.
TEST(Lines, AreMatchedWithinTheirExtent) {
  const FeatureScales scales(edges());
  const LandmarkGrid map({line_at(1, -10, 8, std::numbers::pi, 12), line_at(2, 10, 8, std::numbers::pi, 12)});
  const Pose2 robot{0, 2, 0};
  const auto match_of = [&](double from, double to) {
    MapLandmark line = line_at(3, 0, 8, std::numbers::pi, 1);
    return identify({{}, {line_sighting_at(line, robot, from, to)}},
                    {robot, 1e-3 * Eigen::Matrix3d::Identity()}, map, scales, {})
        .matches.at(0);
  };
  const auto key = [&](const Match& m) {
    return m.verdict == Verdict::matched ? map[m.pairing.landmark].key : 0;
  };
  // The normal points south: to its left is east.
  EXPECT_EQ(key(match_of(5, 9)), 2U);
  EXPECT_EQ(key(match_of(-9, -5)), 1U);
  EXPECT_EQ(match_of(-2, 2).verdict, Verdict::nothing_near) << "an alley";
  // From behind, and as a point, it is not seen.
  EXPECT_NE(identify({{}, {line_sighting_at(line_at(3, 10, -4, 0, 4), robot, -1, 1)}},
                     {robot, 1e-3 * Eigen::Matrix3d::Identity()}, map, scales, {})
                .matches.at(0)
                .verdict,
            Verdict::matched);
}

TEST(Lines, AreSoundWithARangeAndWithoutABearing) {
  SeenLandmark s = line_sighting_at(line_at(1, 4, 8, std::numbers::pi, 30), {0, 0, 0}, -1, 1);
  EXPECT_TRUE(s.is_valid());
  s.bearing = 0.1;
  EXPECT_FALSE(s.is_valid());
  s.bearing.reset();
  s.extent = {1, 1};
  EXPECT_FALSE(s.is_valid());
  s.extent = {0, std::numeric_limits<double>::infinity()};
  EXPECT_FALSE(s.is_valid());
}

}  // namespace
}  // namespace waymark::test
