// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numbers>

#include "localization/detectors/scan_landmarks.hpp"
#include "localization/detectors/wall_lines.hpp"
#include "tests/localization/made_rooms.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

/// Returns the lines that a scan shows in a map with the type `wall` alone.
std::vector<SeenLandmark> wall_lines_of(const LaserScan& scan) {
  TypeRegistry all, types;
  register_landmark_types(all);
  types.add(all[all.id("wall")]);
  return make_laser_detector(types, {.find = "wall_lines"})(scan).sightings;
}

// A room of 7 x 4 m from any pose inside: each wall has the distance, the direction and the ends of its
// truth.
RC_GTEST_PROP(WallLineDetector, MeasuresTheWallsOfARoom, ()) {
  const std::vector<MadeWall> room = chain({{0, 0}, {7, 0}, {7, 4}, {0, 4}, {0, 0}});
  const Pose2 sensor{0.1 * *rc::gen::inRange(15, 55), 0.1 * *rc::gen::inRange(15, 25),
                     0.01 * *rc::gen::inRange(-314, 314)};
  const auto seen = wall_lines_of(scan_walls(room, sensor, 721));
  RC_ASSERT(seen.size() >= 4u);
  for (const SeenLandmark& s : seen) {
    RC_ASSERT(s.is_valid());
    RC_ASSERT(!s.bearing);
    const double yaw = sensor.yaw + s.features.value[0];
    const Eigen::Vector2d normal(std::cos(yaw), std::sin(yaw)), along(-normal.y(), normal.x());
    const Eigen::Vector2d foot = sensor.at() - *s.range * normal;
    // Which wall it is follows from its normal, which looks into the room.
    const bool across = std::abs(normal.x()) > 0.5;
    const double at = across ? foot.x() : foot.y(), limit = across ? 7 : 4;
    RC_ASSERT(std::abs(at - (normal.sum() > 0 ? 0 : limit)) < 0.01);
    for (const double end : {s.extent->from, s.extent->to}) {
      const Eigen::Vector2d p = foot + end * along;
      RC_ASSERT(p.x() > -0.01 && p.x() < 7.01 && p.y() > -0.01 && p.y() < 4.01);
    }
    RC_ASSERT(s.extent->to - s.extent->from > 1);
  }
}

// Of a corridor with noise: errors of distance and direction over what is stated.
TEST(WallLineDetector, StatesItsErrors) {
  const std::vector<MadeWall> corridor = chain({{-15, -1.2}, {15, -1.2}, {15, 1.2}, {-15, 1.2}, {-15, -1.2}});
  double range = 0, direction = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    for (const SeenLandmark& s : wall_lines_of(scan_walls(corridor, {0, 0, 0}, 361, 4.7, 0.03, seed))) {
      if (std::abs(*s.range - 1.2) > 0.5) continue;
      const double across = std::abs(s.features.value[0]) - kRightAngle;
      range += std::pow((*s.range - 1.2) / s.range_sd, 2);
      direction += across * across / s.features.variance[0];
      ++count;
    }
  }
  ASSERT_GT(count, 60);
  EXPECT_LT(range / count, 1);  // what walls deviate from straight lines is part of the statement
  EXPECT_LT(direction / count, 1);
  EXPECT_GT(range / count, 0.02);
  EXPECT_GT(direction / count, 0.02);
}

TEST(WallLineDetector, TakesTheLongestOfManyWalls) {
  std::vector<MadeWall> walls;
  for (int k = 0; k < 9; ++k) {
    const double a = k * 2 * std::numbers::pi / 9, half = 0.6 + 0.08 * k;
    const Eigen::Vector2d normal(std::cos(a), std::sin(a)), along(-normal.y(), normal.x());
    walls.push_back({5 * normal - half * along, 5 * normal + half * along});
  }
  const auto seen = wall_lines_of(scan_walls(walls, {}, 1441));
  ASSERT_EQ(seen.size(), 6u);
  for (const SeenLandmark& s : seen) EXPECT_GT(s.extent->to - s.extent->from, 1.5);
}

// A wall with two doors is one line; one 0.5 m behind it is another.
TEST(WallLineDetector, JoinsThePiecesOfOneWall) {
  std::vector<MadeWall> walls{
      {{-5, 2}, {-2, 2}}, {{-1, 2}, {1.5, 2}}, {{2.5, 2}, {6, 2}}, {{-2, 2.5}, {2.5, 2.5}}};
  const LaserScan scan = scan_walls(walls, {}, 1441, 2 * std::numbers::pi, 0.01, 3);
  const auto pieces = find_wall_lines(scan, {.min_length = 0.5});
  const auto joined = join_collinear(pieces);
  ASSERT_GE(pieces.size(), 3u);
  const WallLine& wall = joined.at(0);
  EXPECT_NEAR(wall.length(), 11, 0.3);
  EXPECT_NEAR(wall.normal.y(), -1, 1e-4);
  EXPECT_NEAR(wall.normal.dot(wall.centre), -2, 0.005);
  for (const WallLine& piece : pieces) {
    if (std::abs(piece.centre.y() - 2) > 0.2) continue;
    EXPECT_LT(wall.angle_variance, piece.angle_variance);
    EXPECT_LT(wall.centre_variance, piece.centre_variance);
  }
  EXPECT_EQ(std::ranges::count_if(joined, [](const WallLine& w) { return w.centre.y() < 2.2; }), 1);
}

TEST(WallLineDetector, LeavesOutShortPiecesAndMapsWithoutWalls) {
  const auto post = chain({{3, -0.2}, {3, 0.2}});
  EXPECT_TRUE(wall_lines_of(scan_walls(post, {}, 721)).empty());
  TypeRegistry poles;
  poles.add({.name = "pole", .summary = "Post", .features = {}});
  EXPECT_TRUE(
      make_laser_detector(poles, {.find = "wall_lines"})(scan_walls(chain({{3, -2}, {3, 2}}), {}, 721))
          .sightings.empty());
}

}  // namespace
}  // namespace waymark::test
