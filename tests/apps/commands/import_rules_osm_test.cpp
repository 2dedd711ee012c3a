// SPDX-License-Identifier: Apache-2.0
// Towns of OpenStreetMap, in its own files and as other programs save them.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "tests/apps/commands/import_rules_fixture.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

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

// A campus, from the extract and as a GeoPackage with layers of other names. Counted in its XML: 20 bollards,
// 6 trees, 530 buildings (505 of them `building=yes`). Two of these are not closed, and one has no area.
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
  EXPECT_EQ(counts[0][0], 527U);
  EXPECT_GT(counts[0][1], 2000U);
  EXPECT_EQ(counts[0][3], 20U);
  EXPECT_EQ(counts[0][4], 6U);
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

TEST_F(ImportRules, HeightsMayBeFeetAndInches) {
  std::string town = kTown;
  town.replace(town.find("v='6 m'"), 7, "v='16&apos;6&quot;'");
  ASSERT_EQ(import(town, "town.osm", {"--rules", "osm"}).code, 0);
  EXPECT_NEAR(landmarks("pole")[0]["height"], 16.5 * 0.3048, 1e-9);
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

}  // namespace
}  // namespace waymark::test
