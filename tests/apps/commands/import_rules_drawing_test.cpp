// SPDX-License-Identifier: Apache-2.0
// Walls and columns of drawings and lanes: units, ends, and local coordinates.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/apps/commands/import_rules_fixture.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(ImportRules, WallsOfZeroLengthAndDegreesWithoutCrs) {
  const char* layer =
      R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"Layer": "WALL"},
      "geometry": {"type": "LineString", "coordinates": [[8.4, 49], [8.4, 49], [8.4001, 49]]}}]})";
  const Outcome metres = import(layer, "hall.geojson", {"--rules", "floor_plan", "--crs", "local"});
  EXPECT_EQ(metres.code, 1);
  EXPECT_THAT(metres.err, HasSubstr("none of the"));
  EXPECT_THAT(metres.err, HasSubstr("wall of zero length"));
  EXPECT_THAT(metres.err, HasSubstr("--crs EPSG:4326"));
  const Outcome degrees = import(layer, "hall.geojson", {"--rules", "floor_plan"});
  ASSERT_EQ(degrees.code, 0) << degrees.err;
  EXPECT_THAT(degrees.err, HasSubstr("1 wall of zero length"));
  EXPECT_NEAR(landmarks("wall")[0]["length"], 7.3, 0.1);  // 1e-4 degrees at 49 degrees north
}

TEST_F(ImportRules, ADrawingInMetresNeedsACrs) {
  const std::string dxf =
      "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nWALLS\n10\n0\n20\n0\n11\n6\n21\n0\n0\nLINE\n8\nWALLS\n10\n0\n20\n"
      "2\n"
      "11\n6\n21\n2\n0\nCIRCLE\n8\nCOLUMNS\n10\n3\n20\n1\n40\n0.3\n0\nENDSEC\n0\nEOF\n";
  const Outcome nowhere = import(dxf, "plan.dxf", {"--rules", "floor_plan"});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("does not name its CRS"));
  const Outcome said = import(dxf, "plan.dxf", {"--rules", "floor_plan", "--map-crs", "local"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(landmarks("wall").size(), 4U);      // two lines with two faces
  EXPECT_EQ(landmarks("wall_end").size(), 8U);  // each end has two of them, too
  ASSERT_EQ(landmarks("pillar").size(), 1U);
  EXPECT_NEAR(landmarks("pillar")[0]["x"], 3, 0.01);
}

/// A room of 6 m by 4 m of single lines, a partition, a column of 0.3 m; lengths times `scale`.
std::string drawing(int unit, double scale) {
  std::string text =
      unit < 0 ? "" : "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n" + std::to_string(unit) + "\n0\nENDSEC\n";
  text += "0\nSECTION\n2\nENTITIES\n";
  const auto number = [&](int code, double metres) {
    text += std::to_string(code) + "\n" + std::to_string(metres * scale) + "\n";
  };
  constexpr double kLines[][4] = {{0, 0, 6, 0}, {6, 0, 6, 4}, {6, 4, 0, 4}, {0, 4, 0, 0}, {3, 1, 3, 3}};
  for (const auto& [x, y, to_x, to_y] : kLines) {
    text += "0\nLINE\n8\nWALLS\n";
    number(10, x), number(20, y), number(11, to_x), number(21, to_y);
  }
  text += "0\nCIRCLE\n8\nCOLUMNS\n";
  number(10, 1), number(20, 2), number(40, 0.15);
  return text + "0\nENDSEC\n0\nEOF\n";
}

TEST_F(ImportRules, ADrawingIsReadInTheUnitThatItStates) {
  struct Case {
    int unit;
    double scale;
    std::vector<std::string> words;
  };
  const Case cases[] = {{-1, 1, {}},
                        {6, 1, {}},
                        {4, 1000, {}},
                        {1, 1 / 0.0254, {}},
                        {4, 1, {"--unit", "m"}},
                        {0, 1000, {"--unit", "mm"}}};
  for (const Case& c : cases) {
    std::vector<std::string> words = {"--rules", "floor_plan", "--map-crs", "local"};
    words.insert(words.end(), c.words.begin(), c.words.end());
    const Outcome said = import(drawing(c.unit, c.scale), "plan.dxf", words);
    ASSERT_EQ(said.code, 0) << said.err;
    const bool converted = c.unit >= 0 && c.unit != 6 && c.words.empty();
    EXPECT_EQ(said.err.find("$INSUNITS") != std::string::npos, converted) << said.err;
    const json pillars = landmarks("pillar"), walls = landmarks("wall"), corners = landmarks("wall_corner");
    ASSERT_EQ(pillars.size(), 1U) << c.unit;
    EXPECT_NEAR(pillars[0]["x"], 1, 1e-4) << c.unit;
    EXPECT_NEAR(pillars[0]["diameter"], 0.3, 0.001) << c.unit;
    ASSERT_EQ(walls.size(), 10U) << c.unit;
    for (const json& wall : walls)
      EXPECT_TRUE(std::abs(double(wall["length"]) - 6) < 1e-3 ||
                  std::abs(double(wall["length"]) - 4) < 1e-3 || std::abs(double(wall["length"]) - 2) < 1e-3)
          << wall["length"];
    EXPECT_EQ(corners.size(), 8U) << c.unit;                // the four lines meet
    EXPECT_EQ(landmarks("wall_end").size(), 4U) << c.unit;  // of the partition alone
    for (const json& end : landmarks("wall_end")) EXPECT_NEAR(end["x"], 3, 1e-4);
  }
  const Outcome unknown =
      import(drawing(4, 1000), "plan.dxf", {"--rules", "floor_plan", "--map-crs", "local", "--unit", "inch"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there is no unit 'inch'"));
  const Outcome projected = import(drawing(4, 1000), "plan.dxf",
                                   {"--rules", "floor_plan", "--map-crs", "EPSG:32633", "--unit", "mm"});
  EXPECT_EQ(projected.code, 2);
  EXPECT_THAT(projected.err, HasSubstr("coordinates in EPSG:32633 have its unit"));
  const Outcome table =
      import("x,y,radius\n1,2,0.5\n", "rocks.csv", {"--type", "rock", "--map-crs", "local", "--unit", "mm"});
  EXPECT_EQ(table.code, 2);
  EXPECT_THAT(table.err, HasSubstr("--unit is for rules"));
}

TEST_F(ImportRules, WaysOfOneWallHaveNoEndsWhereTheyMeet) {
  const Outcome said = import(R"(<osm version='0.6'>
 <node id='1' lat='49' lon='8'/><node id='2' lat='49' lon='8.0002'/><node id='3' lat='49' lon='8.0004'/>
 <node id='4' lat='49.0002' lon='8.0004'/>
 <way id='10'><nd ref='1'/><nd ref='2'/><tag k='type' v='wall'/></way>
 <way id='11'><nd ref='3'/><nd ref='2'/><tag k='type' v='wall'/></way>
 <way id='12'><nd ref='3'/><nd ref='4'/><tag k='type' v='wall'/></way>
</osm>)",
                              "lanes.osm", {"--rules", "lanelet2"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(landmarks("wall").size(), 6U);
  EXPECT_EQ(landmarks("wall_end").size(), 4U);  // at nodes 1 and 4
  const json corners = landmarks("wall_corner");
  ASSERT_EQ(corners.size(), 2U);  // both faces at node 3
  for (const json& corner : corners) {
    EXPECT_NEAR(corner["x"], 8.0004, 1e-9);
    const bool inner = double(corner["opening_angle"]) < std::numbers::pi;
    EXPECT_NEAR(corner["direction"], (inner ? -0.25 : 0.75) * std::numbers::pi, 0.01);  // north-west
  }
}

/// Lines of a plan, turned by 0.3 rad about a point far from the origin.
std::string plan_of(const std::vector<std::vector<Eigen::Vector2d>>& lines) {
  json features = json::array();
  for (const auto& line : lines) {
    json vertices = json::array();
    for (const Eigen::Vector2d& v : line) {
      const Eigen::Vector2d at = Eigen::Vector2d(500000, 5000000) + Eigen::Rotation2Dd(0.3) * v;
      vertices.push_back({at.x(), at.y()});
    }
    features.push_back({{"type", "Feature"},
                        {"properties", {{"Layer", "WALL"}}},
                        {"geometry", {{"type", "LineString"}, {"coordinates", vertices}}}});
  }
  return json{{"type", "FeatureCollection"}, {"features", features}}.dump();
}

TEST_F(ImportRules, APartitionThatMeetsAWallHasTwoCornersAndNoEnd) {
  const Eigen::Vector2d west(-5, 0), middle(0, 0), east(5, 0), north(0, 4);
  // The wall runs through without a vertex, with a vertex, or is drawn in two pieces.
  for (const auto& lines : std::vector<std::vector<std::vector<Eigen::Vector2d>>>{
           {{west, east}, {middle, north}},
           {{north, middle}, {east, west}},
           {{west, middle, east}, {middle, north}},
           {{west, middle}, {middle, east}, {north, middle}},
           {{west, middle, north}, {middle, east}}}) {
    const Outcome said =
        import(plan_of(lines), "plan.geojson", {"--rules", "floor_plan", "--crs", "EPSG:25832"});
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(landmarks("wall_end").size(), 6U);  // of three ends
    const json corners = landmarks("wall_corner");
    ASSERT_EQ(corners.size(), 2U) << said.out;
    std::vector<double> directions;
    for (const json& corner : corners) {
      EXPECT_NEAR(corner["x"], 500000, 0.01);
      EXPECT_NEAR(corner["opening_angle"], std::numbers::pi / 2, 1e-3);
      directions.push_back(corner["direction"]);
    }
    std::ranges::sort(directions);
    EXPECT_NEAR(directions[0], -std::numbers::pi / 4 - 0.3,
                0.06);  // north of the map is not that of the Earth
    EXPECT_NEAR(directions[1], std::numbers::pi / 4 - 0.3, 0.06);
  }
  // Walls that cross have four corners.
  ASSERT_EQ(import(plan_of({{west, middle, east}, {north, middle, -north}}), "plan.geojson",
                   {"--rules", "floor_plan", "--crs", "EPSG:25832"})
                .code,
            0);
  EXPECT_EQ(landmarks("wall_corner").size(), 4U);
  // A partition that ends 20 cm before the wall does not meet it.
  ASSERT_EQ(import(plan_of({{west, east}, {Eigen::Vector2d(0, 0.2), north}}), "plan.geojson",
                   {"--rules", "floor_plan", "--crs", "EPSG:25832"})
                .code,
            0);
  EXPECT_EQ(landmarks("wall_end").size(), 8U);
  EXPECT_TRUE(landmarks("wall_corner").empty());
}

/// A wall of 6 m to the east and 4 m to the north, and a pole, in local_x and local_y; one wall lacks a node.
std::string lanes_with_local_tags(const std::string& lat_lon) {
  std::string text = "<osm version='0.6'>\n";
  const auto node = [&](int id, const std::string& x, const std::string& y, const std::string& more) {
    text += "<node id='" + std::to_string(id) + "' " + lat_lon + "><tag k='local_x' v='" + x +
            "'/><tag k='local_y' v='" + y + "'/><tag k='ele' v='19.5'/><tag k='mgrs_code' v='54SUE000000'/>" +
            more + "</node>\n";
  };
  node(1, "100.25", "200", "");
  node(2, "106.25", "200", "");
  node(3, "106.25", "204", "");
  node(4, "103", "210", "<tag k='type' v='pole'/>");
  return text + R"(<way id='10'><nd ref='1'/><nd ref='2'/><nd ref='3'/><tag k='type' v='wall'/></way>
 <way id='11'><nd ref='1'/><nd ref='99'/><tag k='type' v='wall'/></way></osm>)";
}

TEST_F(ImportRules, LaneletsWithLocalPositions) {
  const auto expect_local = [&](const Outcome& said) {
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_THAT(said.err, HasSubstr("landmarks in local"));
    EXPECT_THAT(said.err, HasSubstr("coordinates that are no numbers"));
    EXPECT_THAT(said.err, HasSubstr("osm_id 11"));
    ASSERT_EQ(landmarks("pole").size(), 1U);
    EXPECT_EQ(landmarks("pole")[0]["x"], 103.0);
    EXPECT_EQ(landmarks("pole")[0]["y"], 210.0);
    EXPECT_EQ(landmarks("pole")[0]["z"], 19.5);
    ASSERT_EQ(landmarks("wall").size(), 4U);  // two faces of two pieces
    for (const json& wall : landmarks("wall"))
      EXPECT_TRUE(std::abs(double(wall["length"]) - 6) < 1e-9 || std::abs(double(wall["length"]) - 4) < 1e-9);
    for (const json& corner : landmarks("wall_corner")) EXPECT_NEAR(corner["x"], 106.25, 1e-9);
    EXPECT_EQ(landmarks("wall_corner").size(), 2U);
  };
  for (const char* none : {"lat='' lon=''", "lat='0.0' lon='0.0'", ""})
    expect_local(import(lanes_with_local_tags(none), "lanes.osm", {"--rules", "lanelet2"}));
  const std::string both = lanes_with_local_tags("lat='49.1' lon='8.4'");
  expect_local(import(both, "lanes.osm", {"--rules", "lanelet2", "--map-crs", "local"}));
  expect_local(import(both, "lanes.osm", {"--rules", "lanelet2", "--crs", "local"}));
  const Outcome degrees = import(both, "lanes.osm", {"--rules", "lanelet2"});
  ASSERT_EQ(degrees.code, 0) << degrees.err;
  EXPECT_NEAR(landmarks("pole")[0]["x"], 8.4, 1e-9);
  const Outcome broken = import(both.substr(0, both.size() - 40), "lanes.osm", {"--rules", "lanelet2"});
  EXPECT_EQ(broken.code, 1);
  EXPECT_THAT(broken.err, HasSubstr("lanes.osm"));
}

}  // namespace
}  // namespace waymark::test
