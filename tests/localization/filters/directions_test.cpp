// SPDX-License-Identifier: Apache-2.0
// Features that are angles turn with the pose, and measure the heading.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>

#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/global/constellation.hpp"
#include "tests/localization/made_world.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

TypeRegistry facing_types() {
  TypeRegistry types;
  types.add({.name = "face",
             .summary = "Something with a front",
             .features = {{"facing", "rad", Scale::direction, -4, 4, "Front, clockwise from north", 0.1}}});
  return types;
}

MapLandmark face_at(double x, double y, double azimuth) {
  MapLandmark face;
  face.key = 1;
  face.at = {x, y};
  face.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  face.features.value[0] = azimuth;
  face.features.variance[0] = 1e-4;
  return face;
}

/// Returns what a robot sees of a landmark without error.
SeenLandmark sight_of(const MapLandmark& face, const Pose2& robot) {
  const Eigen::Vector2d to = face.at - robot.at();
  SeenLandmark s;
  s.type = TypeId{0};
  s.range = to.norm();
  s.range_sd = 0.05;
  s.bearing = wrap_angle(std::atan2(to.y(), to.x()) - robot.yaw);
  s.bearing_sd = 0.01;
  s.features.value[0] = wrap_angle(kRightAngle - face.features.value[0] - robot.yaw);
  s.features.variance[0] = 1e-4;
  return s;
}

PoseEstimate unsure(const Pose2& pose, double sd = 0.3, double yaw_sd = 0.2) {
  return {pose, Eigen::Vector3d(sd * sd, sd * sd, yaw_sd * yaw_sd).asDiagonal()};
}

RC_GTEST_PROP(Directions, AreSeenInTheFrameOfTheSensor, ()) {
  const FeatureScales scales(facing_types());
  const MapLandmark face = face_at(8, 3, 0.01 * *rc::gen::inRange(-314, 314));
  const LandmarkGrid map({face});
  const Pose2 robot{1, 2, 0.01 * *rc::gen::inRange(-314, 314)};
  SeenLandmark s = sight_of(face, robot);
  RC_ASSERT(candidates(s, {}, unsure(robot), map, scales, {}).pairings.size() == 1u);
  s.features.value[0] += std::numbers::pi;  // its back: an axis would not differ
  const auto back = candidates(s, {}, unsure(robot), map, scales, {});
  RC_ASSERT(back.pairings.empty());
  RC_ASSERT(back.verdict == Verdict::features_differ);
}

// One landmark fixes two of three numbers of a pose by range and bearing; its direction fixes the third.
TEST(Directions, CorrectTheHeadingOfEveryFilter) {
  const FeatureScales scales(facing_types());
  const MapLandmark face = face_at(8, 3, 0.4);
  const Pose2 truth{1, 2, 0.5}, guess{1.2, 1.9, 0.6};
  const SightingSet seen{{}, {sight_of(face, truth)}};
  const auto follow = [&](auto&& filter) {
    filter.update(seen);
    return filter.estimate();
  };
  const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid({face})}, scales);
  for (const PoseEstimate& after :
       {follow(ExtendedKalman(unsure(guess), matcher)), follow(UnscentedKalman(unsure(guess), matcher)),
        follow(MultiHypothesisFilter(unsure(guess), matcher))}) {
    EXPECT_NEAR(wrap_angle(after.pose.yaw - truth.yaw), 0, 0.03);
    EXPECT_NEAR((after.pose.at() - truth.at()).norm(), 0, 0.2);
    EXPECT_LT(std::sqrt(after.covariance(2, 2)), 0.03);
    EXPECT_LT(std::sqrt(after.covariance.topLeftCorner<2, 2>().trace()), 0.3);
  }
}

// The slow twin of the sum of evidence: a Kalman update by range, bearing and direction in one matrix.
TEST(Directions, AreARowOfTheInnovation) {
  const FeatureScales scales(facing_types());
  const MapLandmark face = face_at(8, 3, 0.4);
  const LandmarkGrid map({face});
  const PoseEstimate before = unsure({1.1, 2.05, 0.55});
  const SeenLandmark s = sight_of(face, {1, 2, 0.5});
  IdentificationOptions options;
  options.feature_tolerance = 0;
  const Candidates found = candidates(s, {}, before, map, scales, options);
  ASSERT_EQ(found.pairings.size(), 1u);
  const CandidatePair& pair = found.pairings[0];
  EXPECT_EQ(pair.evidence.rows, 3);
  EXPECT_EQ(pair.feature_count, 0) << "a direction is not counted twice";

  const ExpectedSighting e = expect(before.pose, {}, face.at);
  Eigen::Matrix3d h, r = Eigen::Matrix3d::Zero();
  h << e.by_pose, Eigen::RowVector3d(0, 0, -1);
  r.topLeftCorner<2, 2>() = sensor_noise(s) + e.by_landmark * face.covariance * e.by_landmark.transpose();
  r(2, 2) = s.features.variance[0] + face.features.variance[0];
  Eigen::Vector3d v;
  v << innovation(s, e.value), wrap_angle(s.features.value[0] - (kRightAngle - 0.4 - before.pose.yaw));
  const Eigen::Matrix3d sum = h * before.covariance * h.transpose() + r;
  EXPECT_NEAR(pair.squares, v.dot(sum.inverse() * v), 1e-6);
  const PoseEstimate after = update_pose(before, pair.evidence);
  const Eigen::Matrix3d gain = before.covariance * h.transpose() * sum.inverse();
  EXPECT_NEAR((after.pose.vector() - before.pose.vector() - gain * v).norm(), 0, 1e-8);
  EXPECT_NEAR((after.covariance - (before.covariance - gain * h * before.covariance)).norm(), 0, 1e-8);
}

// Errors in units of the covariances, over many drawn sightings: the heading is neither too sure nor too
// unsure.
TEST(Directions, LeaveTheFilterConsistent) {
  const FeatureScales scales(facing_types());
  IdentificationOptions options;
  options.feature_tolerance = 0;
  Random random(5, "directions");
  double squares = 0;
  constexpr int kRuns = 400;
  for (int i = 0; i < kRuns; ++i) {
    const Pose2 truth{1, 2, random.uniform(-3, 3)};
    const PoseEstimate before =
        unsure(pose_of(truth.vector() +
                       Eigen::Vector3d(0.3 * random.normal(), 0.3 * random.normal(), 0.1 * random.normal())),
               0.3, 0.1);
    MapLandmark face = face_at(8, 3, random.uniform(-3, 3));
    SeenLandmark s = sight_of(face, truth);
    *s.range += s.range_sd * random.normal();
    *s.bearing += s.bearing_sd * random.normal();
    s.features.value[0] += 0.01 * random.normal();
    face.at += 0.01 * Eigen::Vector2d(random.normal(), random.normal());
    face.features.value[0] += 0.01 * random.normal();
    ExtendedKalman filter(before, LandmarkMatcher(LandmarkWindow{LandmarkGrid({face})}, scales, options));
    filter.update({{}, {s}});
    const PoseEstimate after = filter.estimate();
    Eigen::Vector3d error = after.pose.vector() - truth.vector();
    error.z() = wrap_angle(error.z());
    squares += error.dot(after.covariance.inverse() * error) / 3;
  }
  EXPECT_NEAR(squares / kRuns, 1, 0.25);
}

// Two rooms alike but for the faces of their landmarks: positions alone fit both.
TEST(Directions, DistinguishPlacesThatPositionsDoNot) {
  std::vector<MapLandmark> all;
  const std::vector<Eigen::Vector2d> room = {{0, 0}, {5, 0.5}, {4.2, 6}, {-1, 3.7}, {2, 9}, {7, 4}};
  for (std::size_t i = 0; i < room.size(); ++i)
    for (const double east : {0.0, 100.0}) {
      MapLandmark face = face_at(room[i].x() + east, room[i].y(), 0.9 * static_cast<double>(i) + 0.02 * east);
      face.key = all.size() + 1;
      all.push_back(face);
    }
  const Pose2 truth{2, 2, 0.7};
  const auto find = [&](const FeatureScales& scales, bool with_faces) {
    SightingSet seen;
    for (std::size_t i = 0; i < all.size(); i += 2) {
      seen.sightings.push_back(sight_of(all[i], truth));
      if (!with_faces) seen.sightings.back().features = {};
    }
    ConstellationOptions options;
    return ConstellationIndex(all, scales, options).find(seen);
  };
  const FeatureScales scales(facing_types());
  EXPECT_FALSE(find(scales, false).fix) << "the rooms are alike: the place is unknown";
  const auto answer = find(scales, true);
  ASSERT_TRUE(answer.fix) << answer.reason;
  EXPECT_NEAR((answer.fix->pose().pose.at() - truth.at()).norm(), 0, 0.1);
}

TEST(Directions, ToleratedBetweenSensorsDoNotDependOnTheirValue) {
  const FeatureScales scales(facing_types());
  KnownFeatures seen, mapped;
  double last = -1;
  for (const double azimuth : {0.0, 1.0, 3.0}) {
    mapped.value[0] = azimuth, seen.value[0] = azimuth + 0.02;
    const double squares = compare_features(scales, 0, seen, mapped, 0.15).squares;
    if (last >= 0) {
      EXPECT_NEAR(squares, last, 1e-9) << azimuth;
    }
    last = squares;
  }
}

}  // namespace
}  // namespace waymark::test
