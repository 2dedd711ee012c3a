// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Two houses of a row, a lamp, a tree, a garage whose outline is not closed, a way without tags.
constexpr const char* kTown = R"(<?xml version='1.0' encoding='UTF-8'?>
<osm version='0.6'>
 <node id='1' lat='49.0000000' lon='8.4000000'/> <node id='2' lat='49.0000000' lon='8.4001367'/>
 <node id='3' lat='49.0000900' lon='8.4001367'/> <node id='4' lat='49.0000900' lon='8.4000000'/>
 <node id='5' lat='49.0000000' lon='8.4002734'/> <node id='6' lat='49.0000900' lon='8.4002734'/>
 <node id='7' lat='49.0010000' lon='8.4000000'><tag k='highway' v='street_lamp'/><tag k='height' v='6 m'/></node>
 <node id='8' lat='49.0020000' lon='8.4010000'><tag k='natural' v='tree'/><tag k='height' v='tall'/>
  <tag k='circumference' v='1,57'/></node>
 <way id='20'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/><tag k='building' v='yes'/></way>
 <way id='21'><nd ref='2'/><nd ref='5'/><nd ref='6'/><nd ref='3'/><nd ref='2'/><tag k='building' v='house'/></way>
 <way id='22'><nd ref='7'/><nd ref='8'/><nd ref='6'/><tag k='building' v='garage'/></way>
 <way id='23'><nd ref='7'/><nd ref='8'/></way>
</osm>
)";

/// The program on files of GIS written here.
class ImportRules : public testing::Test {
 protected:
  Outcome import(const std::string& text, const std::string& name, std::vector<std::string> words) {
    write_text(folder_.path() / name, text);
    words.insert(words.begin(), {"import", folder_ / name, "-o", map_});
    return waymark(words);
  }
  std::string rules(const std::string& text) {
    write_text(folder_.path() / "rules.json", R"({"waymark_rules": 1, "rules": [)" + text + "]}");
    return folder_ / "rules.json";
  }
  json landmarks(const std::string& type) {
    const Outcome said = waymark({"query", map_, "--type", type, "--format", "json"});
    return said.code == 0 ? json::parse(said.out) : json::array();
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg";
};

/// The walls of the houses lie along the graticule. In zone 31 the grid is turned by the meridian
/// convergence.
TEST_F(ImportRules, DirectionsCountFromTheNorthOfTheMap) {
  const double degree = std::numbers::pi / 180;
  const double convergence = std::atan(std::tan(5.4 * degree) * std::sin(49 * degree));
  const std::vector<std::pair<std::string, double>> maps{{"EPSG:4326", 0}, {"EPSG:32631", convergence}};
  for (const auto& [crs, turn] : maps) {
    const Outcome said = import(kTown, "town.osm", {"--rules", "osm", "--map-crs", crs});
    ASSERT_EQ(said.code, 0) << said.err;
    const json walls = landmarks("wall");
    EXPECT_EQ(walls.size(), 6U);
    for (const json& wall : walls)
      EXPECT_NEAR(std::remainder(double(wall["direction"]) + turn, 90 * degree), 0, 0.03 * degree) << crs;
    std::filesystem::remove(map_);
  }
}

TEST_F(ImportRules, ATownOfOpenStreetMap) {
  const Outcome said = import(kTown, "town.osm", {"--rules", "osm"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("pole (highway = street_lamp): 1 elements, 1 landmarks"));
  const json lamps = landmarks("pole"), trees = landmarks("tree");
  ASSERT_EQ(lamps.size(), 1U);
  EXPECT_EQ(lamps[0]["height"], 6.0);
  EXPECT_EQ(lamps[0]["kind"], "street_lamp");
  EXPECT_NEAR(lamps[0]["x"], 8.4, 1e-9);
  ASSERT_EQ(trees.size(), 1U);
  EXPECT_TRUE(trees[0]["height"].is_null());  // "tall" is no number
  EXPECT_NEAR(trees[0]["diameter"], 0.5, 0.001);

  // Two corners each: those between the houses are shared, as is the wall between them.
  EXPECT_EQ(landmarks("building").size(), 2U);
  EXPECT_THAT(said.err, HasSubstr("1 outline that is not closed"));
  EXPECT_EQ(landmarks("wall_corner").size(), 4U);
  EXPECT_EQ(landmarks("wall").size(), 6U);
  EXPECT_THAT(said.err, HasSubstr("4 corner shared with another outline"));
  for (const json& corner : landmarks("wall_corner")) {
    EXPECT_NEAR(corner["opening_angle"], 1.5 * std::numbers::pi, 0.01);
    const double direction = corner["direction"];
    EXPECT_EQ(direction < 0, double(corner["x"]) < 8.4001) << direction;  // the west corners look west
  }
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
}

/// The houses, the lamp and the tree of kTown as programs save them: outlines as polygons or as closed lines,
/// tags as members or as an object.
std::string town_as_geojson(const std::string& outline, bool nested_tags) {
  const auto feature = [&](const std::string& tags, const std::string& type, const std::string& at) {
    return R"({"type": "Feature", "id": "way/1", "properties": {"@id": "way/1")" +
           (nested_tags ? R"(, "tags": {)" + tags + "}" : ", " + tags) + R"(}, "geometry": {"type": ")" +
           type + R"(", "coordinates": )" + at + "}}";
  };
  const auto house = [&](const std::string& kind, const std::string& west, const std::string& east) {
    const std::string ring = "[[" + west + ", 49.0], [" + east + ", 49.0], [" + east + ", 49.00009], [" +
                             west + ", 49.00009], [" + west + ", 49.0]]";
    return feature(R"("building": ")" + kind + "\"", outline, outline == "Polygon" ? "[" + ring + "]" : ring);
  };
  return R"({"type": "FeatureCollection", "features": [)" + house("yes", "8.4", "8.4001367") + "," +
         house("house", "8.4001367", "8.4002734") + "," +
         feature(R"("highway": "street_lamp", "height": "6 m")", "Point", "[8.4, 49.001]") + "," +
         feature(R"("building": "garage")", "LineString", "[[8.4, 49.001], [8.401, 49.002], [8.4, 49.003]]") +
         "," + feature(R"("natural": "tree", "circumference": "1,57")", "Point", "[8.401, 49.002]") + "]}";
}

TEST_F(ImportRules, ATownOfOpenStreetMapSavedAsGeoJson) {
  ASSERT_EQ(import(kTown, "town.osm", {"--rules", "osm"}).code, 0);
  const char* const compared[] = {"building", "wall_corner", "wall", "pole", "tree"};
  std::vector<json> wanted;
  for (const char* type : compared) wanted.push_back(landmarks(type));
  const auto expect_the_town = [&](const std::string& form) {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const json found = landmarks(compared[i]);
      ASSERT_EQ(found.size(), wanted[i].size()) << form << ": " << compared[i];
      for (std::size_t k = 0; k < found.size(); ++k)
        for (const char* value : {"x", "y", "direction", "opening_angle", "length", "diameter", "height"})
          if (wanted[i][k].contains(value) && wanted[i][k][value].is_number()) {
            EXPECT_NEAR(found[k][value], wanted[i][k][value], 1e-6)
                << form << ": " << compared[i] << ' ' << value;
          }
    }
  };
  for (const char* outline : {"Polygon", "LineString"})
    for (const bool nested : {false, true}) {
      const Outcome said = import(town_as_geojson(outline, nested), "data.geojson", {"--rules", "osm"});
      ASSERT_EQ(said.code, 0) << said.err;
      EXPECT_THAT(said.err, HasSubstr("1 outline that is not closed"));
      expect_the_town(std::string(outline) + (nested ? ", nested tags" : ""));
    }
  const std::string table = folder_ / "planet.gpkg";
  ASSERT_EQ(bash("ogr2ogr -nln planet_osm_line " + table + " " + (folder_ / "data.geojson")).code, 0);
  const Outcome said = waymark({"import", table, "-o", map_, "--rules", "osm"});
  ASSERT_EQ(said.code, 0) << said.err;
  expect_the_town("a layer of another name");
}

// 505 buildings of a campus, from the extract and as a GeoPackage with layers of other names.
TEST_F(ImportRules, ARealTownSavedWithOtherLayersIsTheSame) {
  const auto data = std::filesystem::path(WAYMARK_SOURCE_DIR) /
                    "../shared/data/environments/gis/osm_kaiserslautern_uni.osm.gz";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not on this machine";
  const std::string osm = folder_ / "town.osm", other = folder_ / "other.gpkg";
  ASSERT_EQ(bash("gzip -dc '" + data.string() + "' > " + osm).code, 0);
  for (const std::string layer : {"points", "lines", "multipolygons"})
    ASSERT_EQ(bash("ogr2ogr -update -append -nln my_" + layer + " " + other + " " + osm + " " + layer).code,
              0);
  std::vector<std::size_t> counts[2];
  for (const bool converted : {false, true}) {
    const Outcome said = waymark({"import", converted ? other : osm, "-o", map_, "--rules", "osm"});
    ASSERT_EQ(said.code, 0) << said.err;
    for (const char* type : {"building", "wall_corner", "wall", "pole", "tree", "traffic_sign"})
      counts[converted].push_back(landmarks(type).size());
  }
  EXPECT_EQ(counts[0], counts[1]);
  EXPECT_GT(counts[0][0], 500U);
  EXPECT_GT(counts[0][1], 2000U);
}

TEST_F(ImportRules, AnOutlineThatIsNotClosedIsNoBuilding) {
  const Outcome said = import(
      kTown, "town.osm", {"--rules", rules(R"({"type": "building", "geometry": "centroid", "layer": "lines",
                                                    "where": {"building": "*"},
                                                    "features": {"diameter": "geom_diameter"}})")});
  ASSERT_EQ(said.code, 0) << said.err;  // its centroid is known, its diameter is not
  EXPECT_TRUE(landmarks("building")[0]["diameter"].is_null());
  const Outcome outline = import(
      kTown, "town.osm",
      {"--rules", rules(R"({"type": "building", "geometry": "outline", "where": {"building": "*"}})")});
  ASSERT_EQ(outline.code, 0) << outline.err;
  EXPECT_EQ(landmarks("building").size(), 2U);
  EXPECT_THAT(outline.err, HasSubstr("1 outline that is not closed"));
  EXPECT_THAT(outline.err, HasSubstr("osm_id 22"));
}

TEST_F(ImportRules, FilesWithoutTagsAreRefused) {
  const Outcome said = import(R"(<osm version='0.6'>
 <node id='1' lat='49' lon='8.4'/><node id='2' lat='49.1' lon='8.4'/><way id='3'><nd ref='1'/><nd ref='2'/></way>
</osm>)",
                              "plain.osm", {"--rules", "osm"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("the file has no elements with tags or columns"));
  EXPECT_THAT(said.err, HasSubstr("plain.osm"));
}

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
  EXPECT_EQ(landmarks("wall_end").size(), 8U);  // of which each end has two, too
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

TEST_F(ImportRules, WhatIsNoBuildingIsNone) {
  std::string town = kTown;
  town.replace(town.find("v='house'"), 9, "v='no'");
  ASSERT_EQ(import(town, "town.osm", {"--rules", "osm"}).code, 0);
  EXPECT_EQ(landmarks("building").size(), 1U);
  EXPECT_EQ(landmarks("wall").size(), 4U);
  town.replace(town.find("v='yes'"), 7, "v='roof'");  // a roof on posts
  ASSERT_EQ(import(town, "town.osm", {"--rules", "osm"}).code, 0);
  EXPECT_EQ(landmarks("building").size(), 1U);
  EXPECT_EQ(landmarks("wall").size(), 0U);
}

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

TEST_F(ImportRules, HeightsMayBeFeetAndInches) {
  std::string town = kTown;
  town.replace(town.find("v='6 m'"), 7, "v='16&apos;6&quot;'");
  ASSERT_EQ(import(town, "town.osm", {"--rules", "osm"}).code, 0);
  EXPECT_NEAR(landmarks("pole")[0]["height"], 16.5 * 0.3048, 1e-9);
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

TEST_F(ImportRules, FaultsOfRulesAreNamed) {
  const auto fault = [&](const std::string& text) {
    const Outcome said = import(kTown, "town.osm", {"--rules", rules(text)});
    EXPECT_NE(said.code, 0);
    return said.err;
  };
  EXPECT_THAT(fault(R"({"type": "lamp"})"), HasSubstr("lamp"));
  EXPECT_THAT(fault(R"({"type": "pole", "wher": {}})"), HasSubstr("wher"));
  EXPECT_THAT(fault(R"({"type": "pole", "features": {"hight": "height"}})"),
              HasSubstr("pole has no feature 'hight'"));
  EXPECT_THAT(fault(R"({"type": "pole", "features": {"height": "2*("}})"),
              HasSubstr("the expression ends too early"));
  EXPECT_THAT(fault(R"({"type": "pole", "geometry": "middle"})"), HasSubstr("it is one of"));
  const std::string none = fault(R"({"type": "pole", "where": {"highway": "lamp"}})");
  EXPECT_THAT(none, HasSubstr("none of the 5 elements matches a rule"));
  EXPECT_THAT(none, HasSubstr("building (3), height (2)"));
  const Outcome unknown = import(kTown, "town.osm", {"--rules", "osn"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there are no ready rules 'osn'"));
  const Outcome both = import(kTown, "town.osm", {"--rules", "osm", "--type", "pole"});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--type is for tables"));
}

TEST_F(ImportRules, ReadyRulesCanBePrintedAndReadAgain) {
  for (const char* name : {"osm", "lanelet2", "trees", "lamps", "cityjson", "floor_plan"}) {
    const Outcome printed = waymark({"import", "--rules", name, "--print-rules"});
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_TRUE(json::accept(printed.out)) << name;
  }
}

}  // namespace
}  // namespace waymark::test
