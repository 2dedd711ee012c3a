// SPDX-License-Identifier: Apache-2.0
// Objects that are seen again, and what they may prove.
#include <gtest/gtest.h>

#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/identification/sighting_follower.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

BodyMotion step(double forward, double turn) {
  return {.step = {forward, 0, turn}, .covariance = Eigen::Matrix3d::Zero()};
}

SightingSet looking(const Pose2& robot, const std::vector<Eigen::Vector2d>& objects) {
  SightingSet seen;
  for (const Eigen::Vector2d& object : objects) {
    const Eigen::Vector2d from = object - robot.at();
    seen.sightings.push_back(seen_at(from.norm(), wrap_angle(std::atan2(from.y(), from.x()) - robot.yaw)));
  }
  return seen;
}

TEST(SightingFollower, FollowsObjectsWhileTheRobotMovesAndTurns) {
  SightingFollower follower;
  Pose2 robot;
  const std::vector<Eigen::Vector2d> objects{{5, 1}, {6, -2}, {8, 3}};
  const auto first = follower.follow(looking(robot, objects));
  for (const auto& seen : first) EXPECT_LT(seen.metres, 0);
  for (int i = 0; i < 5; ++i) {
    follower.predict(step(0.4, 0.1));
    robot = robot * Pose2{0.4, 0, 0.1};
    const auto again = follower.follow(looking(robot, {objects[2], objects[0], objects[1], {4, 5}}));
    EXPECT_EQ(again[0].object, first[2].object);
    EXPECT_EQ(again[1].object, first[0].object);
    EXPECT_EQ(again[2].object, first[1].object);
    EXPECT_NEAR(again[0].metres, 0.4, 1e-9);
    EXPECT_EQ(again[3].metres < 0, i == 0);
  }
}

TEST(SightingFollower, ForgetsAndDoesNotFollowBearings) {
  SightingFollower follower;
  follower.follow(looking({}, {{5, 0}}));
  EXPECT_EQ(follower.follow(looking({}, {{5, 0}}))[0].metres, 0);
  SightingSet direction = looking({}, {{5, 0}});
  direction.sightings[0].range.reset();
  EXPECT_LT(follower.follow(direction)[0].metres, 0);
  for (int i = 0; i < 6; ++i) follower.predict(step(1, 0));
  EXPECT_LT(follower.follow(looking({6, 0, 0}, {{5, 0}}))[0].metres, 0);
}

// A map has one landmark. The robot stands and sees an object a metre beside it: perhaps that landmark from a
// pose a metre off, perhaps an object the map lacks. Looking again and again decides nothing.
TEST(MultiHypothesisFilter, StandingStillProvesNothingNew) {
  IdentificationOptions options;
  options.use_identities = false;
  const std::vector<MapLandmark> map{landmark_at(8, 0, 1)};
  MultiHypothesisFilter filter({{}, Eigen::Vector3d(0.25, 0.25, 0.005).asDiagonal()},
                               LandmarkMatcher(LandmarkWindow{LandmarkGrid(map)}, {}, options));
  const SightingSet seen = looking({}, {{8, 2.1}});
  const double first = filter.update(seen)[0].unmapped;
  EXPECT_GT(first, 0.02);
  EXPECT_LT(first, 0.98);
  double last = first;
  for (int i = 0; i < 30; ++i) {
    filter.predict(step(0, 0));
    last = filter.update(seen)[0].unmapped;
  }
  std::printf("unmapped: %.3f at first, %.3f at last\n", first, last);
  EXPECT_NEAR(last, first, 0.15);
}

}  // namespace
}  // namespace waymark::test
