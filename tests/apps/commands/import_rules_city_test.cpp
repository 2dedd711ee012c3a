// SPDX-License-Identifier: Apache-2.0
// Buildings and trees of city models in CityJSON.
#include <gmock/gmock.h>

#include <numbers>

#include "tests/apps/commands/import_rules_fixture.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(ImportRules, AttributesOfACityModelDoNotHideItsTypesNorInstancesStopIt) {
  const Outcome said = import(R"({"type": "CityJSON", "version": "2.0",
    "CityObjects": {
      "b": {"type": "Building", "attributes": {"type": "house", "id": 7},
            "geometry": [{"type": "MultiSurface", "lod": "0", "boundaries": [[[0, 1, 2, 3]]]}]},
      "t": {"type": "SolitaryVegetationObject", "attributes": {"height": 12},
            "geometry": [{"type": "GeometryInstance", "template": 0, "boundaries": [4],
                          "transformationMatrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]}},
    "geometry-templates": {"templates": [{"type": "MultiSurface", "lod": "2", "boundaries": [[[0, 1, 2]]]}],
                           "vertices-templates": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]},
    "vertices": [[0, 0, 0], [10, 0, 0], [10, 8, 0], [0, 8, 0], [20, 3, 1]]})",
                              "city.json", {"--rules", "cityjson", "--map-crs", "local"});
  ASSERT_EQ(said.code, 0) << said.err;
  const json buildings = landmarks("building"), trees = landmarks("tree");
  ASSERT_EQ(buildings.size(), 1U);
  EXPECT_EQ(buildings[0]["name"], "b");
  ASSERT_EQ(trees.size(), 1U);
  EXPECT_EQ(trees[0]["x"], 20.0);
  EXPECT_EQ(trees[0]["y"], 3.0);
}

TEST_F(ImportRules, BuildingsOfACityModelStandOnTheirGround) {
  const Outcome said = import(R"({"type": "CityJSON", "version": "1.1",
    "transform": {"scale": [0.01, 0.01, 0.01], "translate": [85000, 447000, 0]},
    "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"},
    "CityObjects": {"b1": {"type": "Building", "attributes": {"measuredHeight": 9.5}, "geometry": [
      {"type": "Solid", "lod": "1.2", "boundaries": [[[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]],
       [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]],
       "semantics": {"surfaces": [{"type": "GroundSurface"}, {"type": "RoofSurface"}, {"type": "WallSurface"}],
                     "values": [[0, 1, 2, 2, 2, 2]]}}]}},
    "vertices": [[0, 0, 100], [1000, 0, 100], [1000, 500, 100], [0, 500, 100],
                 [0, 0, 1050], [1000, 0, 1050], [1000, 500, 1050], [0, 500, 1050]]})",
                              "city.json", {"--rules", "cityjson"});
  ASSERT_EQ(said.code, 0) << said.err;
  const json buildings = landmarks("building");
  ASSERT_EQ(buildings.size(), 1U);
  EXPECT_NEAR(buildings[0]["x"], 85005, 0.01);
  EXPECT_NEAR(buildings[0]["y"], 447002.5, 0.01);
  EXPECT_NEAR(buildings[0]["z"], 1, 0.01);
  EXPECT_EQ(buildings[0]["height"], 9.5);
  EXPECT_EQ(landmarks("wall_corner").size(), 4U);
}

// A front house of 10 m by 5 m with a wing of 5 m by 5 m behind its west half; the whole is an L.
TEST_F(ImportRules, ABuildingStandsOnTheGroundOfItsParts) {
  const std::string parts =
      R"("wing": {"type": "BuildingPart", "parents": ["house"], "attributes": {"measuredHeight": 6},
        "geometry": [{"type": "MultiSurface", "lod": "0", "boundaries": [[[3, 6, 5, 4]]]}]},
      "front": {"type": "BuildingPart", "parents": ["house"], "attributes": {"measuredHeight": 9},
        "geometry": [{"type": "MultiSurface", "lod": "0", "boundaries": [[[0, 1, 2, 6, 3]]]}]}},
    "vertices": [[0, 0, 3], [10, 0, 3], [10, 5, 3], [0, 5, 3], [0, 10, 3], [5, 10, 3], [5, 5, 3]]})";
  const auto city = [&](const std::string& house) {
    return R"({"type": "CityJSON", "version": "2.0", "CityObjects": {
      "house": {"type": "Building", "children": ["front", "wing", "gone"])" +
           house + "}," + parts;
  };
  const auto expect_the_house = [&](const std::string& text, double x, double y, double height) {
    const Outcome said = import(text, "city.json", {"--rules", "cityjson", "--map-crs", "local"});
    ASSERT_EQ(said.code, 0) << said.err;
    const json buildings = landmarks("building");
    ASSERT_EQ(buildings.size(), 1U) << said.err;
    EXPECT_EQ(buildings[0]["name"], "house");
    EXPECT_NEAR(buildings[0]["x"], x, 1e-6);
    EXPECT_NEAR(buildings[0]["y"], y, 1e-6);
    EXPECT_EQ(buildings[0]["height"], height);
    EXPECT_EQ(landmarks("wall").size(), 7U);  // of the parts, without the one that they share
    const json corners = landmarks("wall_corner");
    ASSERT_EQ(corners.size(), 5U);  // those on the border of both parts are shared
    for (const json& corner : corners) EXPECT_NEAR(corner["opening_angle"], 1.5 * std::numbers::pi, 0.01);
  };
  // 50 m2 about (5, 2.5) and 25 m2 about (2.5, 7.5)
  expect_the_house(city(""), (50 * 5 + 25 * 2.5) / 75, (50 * 2.5 + 25 * 7.5) / 75, 9);
  const std::string own = R"(, "attributes": {"measuredHeight": 8},
        "geometry": [{"type": "MultiSurface", "lod": "0", "boundaries": [[[0, 1, 2, 3]]]}])";
  expect_the_house(city(own), 5, 2.5, 8);
}

}  // namespace
}  // namespace waymark::test
