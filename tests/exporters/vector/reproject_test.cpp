// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/reproject.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

const Crs kGeographic = Crs::from_text("EPSG:4326");
const Crs kUtm19S = Crs::from_text("EPSG:32719");

TEST(Reproject, MovesPositionsAndSaddlesAlike) {
  const geodb::MapContents map = test::three_summits("EPSG:4326", -70.01, -32.65, 0.1);
  const LandmarkType& type = map.types[map.landmarks[0].type];
  const Reprojected there = reproject(map.landmarks, type, kGeographic, kUtm19S);
  const Landmark& one = there.landmarks[0];
  EXPECT_NEAR(one.position.xyz.x(), 405277.1855, 1e-3);  // gdaltransform
  EXPECT_NEAR(one.position.xyz.y(), 6387062.5518, 1e-3);
  EXPECT_EQ(one.position.xyz.z(), 3000);
  EXPECT_EQ(std::get<double>(one.attributes[attribute_index(type, "saddle_x")]), one.position.xyz.x());
  EXPECT_EQ(std::get<double>(one.attributes[attribute_index(type, "saddle_y")]), one.position.xyz.y());
  EXPECT_TRUE(std::holds_alternative<std::monostate>(one.attributes[attribute_index(type, "higher_x")]));
}

/// Polar stereographic, at 90 degrees east: x grows to the north, y to the west.
TEST(Reproject, TurnsCovariancesAndDirectionsToTheOtherAxes) {
  const Crs degrees = Crs::from_text("IAU_2015:30100"), polar = Crs::from_text("IAU_2015:30135");
  LandmarkType type;
  type.features = {{.name = "radius", .unit = "m", .scale = Scale::ratio, .summary = ""},
                   {.name = "orientation", .unit = "rad", .scale = Scale::axis, .summary = ""}};
  Landmark one;
  one.position = {{90, -85, 12}};
  one.covariance = Eigen::Vector3d(1, 4, 0.25).asDiagonal();
  one.features = {{10, 0, 1}, {0.3, 0, 1}};
  const Landmark there = reproject({one}, type, degrees, polar).landmarks.at(0);
  EXPECT_NEAR(there.covariance(0, 0), 4, 1e-6);
  EXPECT_NEAR(there.covariance(1, 1), 1, 1e-6);
  EXPECT_EQ(there.covariance(2, 2), 0.25);
  EXPECT_NEAR(there.features[1].value, 0.3 + std::numbers::pi / 2 - std::numbers::pi, 1e-6);
  EXPECT_EQ(there.features[0].value, 10);
  const Landmark back = reproject({there}, type, polar, degrees).landmarks.at(0);
  EXPECT_LE((back.covariance - one.covariance).norm(), 1e-6);
  EXPECT_NEAR(back.features[1].value, 0.3, 1e-6);
}

TEST(Reproject, ToTheSameCrsChangesNothing) {
  const geodb::MapContents map = test::three_summits("EPSG:4326", -70.01, -32.65, 0.1);
  const Reprojected there =
      reproject(map.landmarks, map.types[map.landmarks[0].type], kGeographic, kGeographic);
  EXPECT_EQ(there.landmarks[0].position, map.landmarks[0].position);
}

TEST(Reproject, CountsPositionsOutsideTheOtherCrs) {
  geodb::MapContents map = test::three_summits("EPSG:4326", -70.01, -32.65, 0.1);
  map.landmarks[1].position.xyz.y() = 120;  // no such latitude
  const Reprojected there = reproject(map.landmarks, map.types[map.landmarks[0].type], kGeographic, kUtm19S);
  EXPECT_EQ(there.landmarks.size(), 2u);
  EXPECT_EQ(there.lost, 1);
}

}  // namespace
}  // namespace waymark::test
