// SPDX-License-Identifier: Apache-2.0
#include "planning/obstacle_memory.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "landmarks/landmark_type.hpp"
namespace waymark::test {
using namespace planning;
namespace {

using localization::Pose2;

HazardObject rock_at(double x, double y) {
  return {.position = {x, y}, .radius = 0.5, .radius_sd = 0.1, .probability = 0.9};
}

TEST(ObstacleMemory, TwoSightingsConfirmAndMissesForget) {
  ObstacleMemory memory;
  const HazardObject ahead[] = {rock_at(6, 0)};
  memory.add(ahead, {});
  ASSERT_EQ(memory.obstacles().size(), 1u);
  EXPECT_FALSE(memory.obstacles()[0].confirmed());
  memory.add({}, {});
  memory.add({}, {});
  EXPECT_TRUE(memory.obstacles().empty());

  memory.add(ahead, {});
  memory.add(ahead, {});
  EXPECT_TRUE(memory.obstacles()[0].confirmed());
  EXPECT_NEAR(memory.obstacles()[0].radius, 0.7, 1e-12);
}

TEST(ObstacleMemory, KeepsWhatItPassesAndForgetsWhatIsFar) {
  ObstacleMemory memory;
  const HazardObject seen[] = {rock_at(6, 2)};
  memory.add(seen, {});
  memory.add(seen, {});
  // Beside and behind the vehicle nothing is expected: no miss counts.
  for (int i = 0; i < 10; ++i) memory.add({}, Pose2{8, 0, 0});
  ASSERT_EQ(memory.obstacles().size(), 1u);
  EXPECT_EQ(memory.obstacles()[0].at, Eigen::Vector2d(6, 2));
  memory.add({}, Pose2{40, 0, 0});
  EXPECT_TRUE(memory.obstacles().empty());
}

TEST(ObstacleMemory, OneObstacleStaysOneFromAnyPose) {
  ObstacleMemory memory;
  const HazardObject first[] = {rock_at(6, 0)};
  memory.add(first, {});
  // The same rock from (2, -4), heading north: 4 m ahead and 4 m to the right.
  const HazardObject second[] = {rock_at(4, -4)};
  memory.add(second, Pose2{2, -4, std::numbers::pi / 2});
  ASSERT_EQ(memory.obstacles().size(), 1u);
  EXPECT_NEAR((memory.obstacles()[0].at - Eigen::Vector2d(6, 0)).norm(), 0, 1e-12);
}

TEST(ObstacleMemory, WhatCannotBeRuledOutIsConfirmed) {
  ObstacleMemory memory;
  const HazardObject seen[] = {rock_at(6, 0)};
  memory.add(seen, {});
  memory.confirm_all();
  EXPECT_TRUE(memory.obstacles()[0].confirmed());
}

TEST(ObstacleMemory, LowObjectsAreNone) {
  ObstacleMemory memory;
  HazardObject low = rock_at(6, 0);
  low.probability = 0.05;
  memory.add({&low, 1}, {});
  EXPECT_TRUE(memory.obstacles().empty());
}

TEST(HazardSeen, HeightDecidesAndALineScannerSeesOnlyWhatIsHigher) {
  TypeRegistry types;
  register_landmark_types(types);
  const Vehicle rover = find_vehicle("rover");  // passes 0.35 m
  localization::SeenLandmark rock;
  rock.type = types.id("rock");
  rock.range = 5, rock.bearing = 0;
  rock.features.value[0] = 0.3;
  const auto probability = [&](double min_height) {
    return hazard_seen(rock, {0.6, 0, 0}, types, rover, min_height).probability;
  };
  EXPECT_NEAR(hazard_seen(rock, {0.6, 0, 0}, types, rover, 0).position.x(), 5.6, 1e-12);
  EXPECT_NEAR(probability(0.35), 0.5, 1e-6);
  EXPECT_GT(probability(0.5), 0.9);
  rock.features.value[1] = 0.15;  // a height that was measured
  EXPECT_LT(probability(0.5), 0.01);
  rock.range.reset();
  EXPECT_EQ(probability(0.5), 0);
}

}  // namespace
}  // namespace waymark::test
