// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/building_landmarks.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "tests/pipeline/buildings/made_town.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kPi = std::numbers::pi;

TypeRegistry all_of_them() {
  TypeRegistry types;
  register_landmark_types(types);
  return types;
}

/// A house of 10 m by 6 m, 5 m high, whose south-west corner lies 20 m east and 50 m south of the first cell.
DetectedBuilding made_house() {
  DetectedBuilding b;
  b.outline.outer = {{{20, -50}, {30, -50}, {30, -44}, {20, -44}}, {0.1, 0.1, 0.1, 0.1}};
  b.area = 60, b.height = 5, b.height_sd = 0.1, b.ground = 300, b.confidence = 0.9;
  b.wall_heights = {4, 4.5, 4, 4.5};
  b.roof = RoofKind::flat;
  return b;
}

struct Made {
  TypeRegistry types = all_of_them();
  BuildingLandmarks all;
  std::vector<Landmark> of(const char* type) const {
    std::vector<Landmark> some;
    for (const Landmark& l : all.landmarks)
      if (l.type == types.id(type)) some.push_back(l);
    return some;
  }
  double feature(const Landmark& l, const char* name) const {
    return l.features[feature_index(types[l.type], name)].value;
  }
};

Made landmarks_of(const DetectedBuilding& building, const WallRules& rules) {
  const TownCanopy canopy({.side = 100}, {}, 4);  // cells of 0.5 m; the first centre at (0.25, 99.75)
  Made made;
  made.all = building_landmarks(std::vector{building}, canopy, made.types, rules);
  return made;
}

TEST(BuildingLandmarks, AHouseHasFourWallsAndFourCorners) {
  const Made made = landmarks_of(made_house(), {.overhang_sd = 0, .survey_sd = 0});
  ASSERT_EQ(made.of("building").size(), 1U);
  const Landmark house = made.of("building")[0];
  EXPECT_NEAR(house.position.xyz.x(), 25.25, 1e-9);
  EXPECT_NEAR(house.position.xyz.y(), 52.75, 1e-9);
  EXPECT_EQ(house.position.xyz.z(), 300);
  EXPECT_NEAR(made.feature(house, "diameter"), std::sqrt(240 / kPi), 1e-9);
  EXPECT_NEAR(std::abs(made.feature(house, "orientation")), kPi / 2, 1e-9);  // east-west
  ASSERT_EQ(made.of("wall").size(), 4U);
  for (const Landmark& wall : made.of("wall")) {
    const Eigen::Vector2d out = wall.position.xyz.head<2>() - house.position.xyz.head<2>();
    EXPECT_NEAR(made.feature(wall, "direction"), std::atan2(out.x(), out.y()), 1e-9);
    // Known across the wall only.
    const Eigen::Vector2d normal = out.normalized(), along(-normal.y(), normal.x());
    EXPECT_NEAR(normal.dot(wall.covariance.topLeftCorner<2, 2>() * normal), 0.01, 1e-9);
    const double length = made.feature(wall, "length");
    EXPECT_NEAR(along.dot(wall.covariance.topLeftCorner<2, 2>() * along), 0.01 + length * length / 12, 1e-9);
    EXPECT_NEAR(made.feature(wall, "height"), length == 10 ? 4 : 4.5, 1e-9);
  }
  ASSERT_EQ(made.of("wall_corner").size(), 4U);
  for (const Landmark& corner : made.of("wall_corner")) {
    EXPECT_NEAR(made.feature(corner, "opening_angle"), 1.5 * kPi, 1e-9);
    EXPECT_NEAR(corner.covariance(0, 0), 0.01, 1e-9);
    EXPECT_NEAR(corner.covariance(1, 1), 0.01, 1e-9);
  }
  ASSERT_EQ(made.all.footprints.size(), 1U);
  EXPECT_EQ(made.all.footprints[0].uid, house.uid);
  EXPECT_EQ(made.all.evidence.size(), made.all.landmarks.size());
}

TEST(BuildingLandmarks, EavesMoveWallsAndCornersIn) {
  const Made made = landmarks_of(made_house(), {.overhang = 0.5});
  double left = 1e9, right = 0;
  for (const Landmark& corner : made.of("wall_corner"))
    left = std::min(left, corner.position.xyz.x()), right = std::max(right, corner.position.xyz.x());
  EXPECT_NEAR(left, 20.75, 1e-9);
  EXPECT_NEAR(right, 29.75, 1e-9);
  EXPECT_NEAR(made.all.footprints[0].rings[0][0].x(), 20.25, 1e-9);  // the roof stays
}

TEST(BuildingLandmarks, AnOutlineAlongCellsHasNoWalls) {
  DetectedBuilding rough = made_house();
  rough.outline.kind = OutlineKind::cells;
  const Made made = landmarks_of(rough, {});
  EXPECT_EQ(made.of("building").size(), 1U);
  EXPECT_EQ(made.all.landmarks.size(), 1U);
}

TEST(BuildingLandmarks, WallsOfCourtyardsFaceThem) {
  DetectedBuilding house = made_house();
  house.outline.outer.vertices = {{20, -60}, {40, -60}, {40, -40}, {20, -40}};
  house.outline.holes = {{{{27, -53}, {27, -47}, {33, -47}, {33, -53}}, {0.1, 0.1, 0.1, 0.1}}};
  const Made made = landmarks_of(house, {});
  EXPECT_EQ(made.of("wall").size(), 8U);
  const Landmark building = made.of("building")[0];
  int facing = 0;
  for (const Landmark& wall : made.of("wall")) {
    const Eigen::Vector2d out = wall.position.xyz.head<2>() - building.position.xyz.head<2>();
    if (out.norm() > 5) continue;
    const double to_middle = std::atan2(-out.x(), -out.y());
    facing += std::abs(std::remainder(made.feature(wall, "direction") - to_middle, 2 * kPi)) < 1e-9;
  }
  EXPECT_EQ(facing, 4);
}

TEST(PoleLandmarks, HaveHeightAndNoDiameter) {
  const TownCanopy canopy({.side = 100}, {}, 4);
  const TypeRegistry types = all_of_them();
  const DetectedPole pole{.at = {10, -20}, .sd = 0.1, .height = 7, .ground = 300, .returns = 8};
  const auto made = pole_landmarks(std::vector{pole}, canopy, types, 0.1);
  ASSERT_EQ(made.landmarks.size(), 1U);
  const Landmark& l = made.landmarks[0];
  const LandmarkType& type = types[l.type];
  EXPECT_EQ(l.features[feature_index(type, "height")].value, 7);
  EXPECT_EQ(l.features[feature_index(type, "diameter")].observations, 0);
  EXPECT_NEAR(l.covariance(0, 0), 0.02, 1e-12);
}

}  // namespace
}  // namespace waymark::test
