// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/reproject.hpp"

#include <gtest/gtest.h>

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
