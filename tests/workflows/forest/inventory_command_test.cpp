// SPDX-License-Identifier: Apache-2.0
// `waymark inventory` and `waymark simulate` with a forest, as people call them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>
#include <variant>

#include "core/text_file.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

struct Outcome {
  int code = 0;
  std::string text;
};

class InventoryCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "waymark-stands-XXXXXX").string();
    folder = ::mkdtemp(name.data());
    // Ten trees on a hectare, and one in its neighbour.
    std::string trees = "uid,x,y,height,diameter,crown_diameter\n";
    for (int i = 0; i < 10; ++i)
      trees += "t" + std::to_string(i) + "," + std::to_string(440005 + 10 * i) + ",5400050,20,0.3,4\n";
    write("trees.csv", trees + "far,440150,5400050,25,0.5,6\n");
    EXPECT_EQ(waymark("import trees.csv -o trees.gpkg --type tree --map-crs EPSG:32632").code, 0);
    write("stands.geojson", R"({"type":"FeatureCollection",
 "crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},"features":[
 {"type":"Feature","properties":{"name":"west"},"geometry":{"type":"Polygon","coordinates":
  [[[440000,5400000],[440100,5400000],[440100,5400100],[440000,5400100],[440000,5400000]]]}},
 {"type":"Feature","properties":{"name":"east"},"geometry":{"type":"Polygon","coordinates":
  [[[440100,5400000],[440200,5400000],[440200,5400100],[440100,5400100],[440100,5400000]]]}}]})");
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return read_text(folder / name, "the output"); }
  Outcome waymark(const std::string& words) const {
    Outcome reported;
    const std::string line = "cd '" + folder.string() + "' && " + WAYMARK_PROGRAM + " " + words + " 2>&1";
    std::FILE* pipe = ::popen(line.c_str(), "r");
    std::array<char, 4096> part{};
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe))
      reported.text.append(part.data(), n);
    reported.code = WEXITSTATUS(::pclose(pipe));
    return reported;
  }
  /// A cell of a CSV by row and column name.
  std::string cell(const std::string& file, std::size_t row, const std::string& column) const {
    std::istringstream lines(read(file));
    std::string line, name;
    std::getline(lines, line);
    std::istringstream names(line);
    std::size_t at = 0;
    while (std::getline(names, name, ',') && name != column) ++at;
    for (std::size_t i = 0; i <= row; ++i) std::getline(lines, line);
    std::istringstream cells(line);
    for (std::size_t i = 0; i <= at; ++i)
      if (!std::getline(cells, name, ',')) name.clear();
    return name;
  }

  fs::path folder;
};

TEST_F(InventoryCommand, WritesALinePerStand) {
  const Outcome reported = waymark("inventory trees.gpkg --stands stands.geojson -o out.csv");
  ASSERT_EQ(reported.code, 0) << reported.text;
  EXPECT_EQ(cell("out.csv", 0, "stand"), "west");
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "area_ha")), 1, 1e-9);
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "stems_per_ha")), 10, 1e-9);
  EXPECT_EQ(cell("out.csv", 0, "stems_per_ha_detected"), cell("out.csv", 0, "stems_per_ha"))
      << "a list has all its trees";
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "basal_area_m2_per_ha")), 0.706858, 1e-6);
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "lorey_height_m")), 20, 1e-9);
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "quadratic_mean_diameter_cm")), 30, 1e-9);
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "volume_m3_per_ha")), 0.47 * 0.706858 * 20, 1e-4);
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "cover")), 10 * 12.566 / 1e4, 2e-3);
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "stems_per_ha_d030")), 10, 1e-9);
  EXPECT_EQ(cell("out.csv", 1, "trees"), "1");
  EXPECT_NEAR(std::stod(cell("out.csv", 1, "dominant_height_m")), 25, 1e-9);
}

TEST_F(InventoryCommand, PrintsTheTableAsJson) {
  const Outcome printed =
      waymark("inventory trees.gpkg --stands stands.geojson -o out.csv --format json --quiet");
  ASSERT_EQ(printed.code, 0) << printed.text;
  const auto stands = nlohmann::json::parse(printed.text);
  ASSERT_EQ(stands.size(), 2);
  for (std::size_t row = 0; row < 2; ++row)
    for (const auto& [column, value] : stands[row].items()) {
      const std::string text = cell("out.csv", row, column);
      if (value.is_number()) {
        EXPECT_NEAR(value.get<double>(), std::stod(text), 1e-9 * std::stod(text)) << column;
      } else {
        EXPECT_EQ(value.is_null() ? "" : value.get<std::string>(), text) << column;
      }
    }
}

TEST_F(InventoryCommand, AddsLayersToACopyOrToTheMapItself) {
  for (const char* out : {"copy.gpkg", "trees.gpkg"}) {
    const Outcome reported = waymark(std::string("inventory trees.gpkg --stands stands.geojson -o ") + out);
    ASSERT_EQ(reported.code, 0) << reported.text;
    EXPECT_THAT(geodb::validate_map(folder / out), ::testing::IsEmpty());
    EXPECT_EQ(geodb::read_shape_layer(folder / out, "stand").rows.size(), 2u);
    EXPECT_EQ(geodb::read_shape_layer(folder / out, "stand_tree").rows.size(), 11u);
  }
  EXPECT_THAT(waymark("query copy.gpkg --type tree --format csv").text, HasSubstr("far"));
}

TEST_F(InventoryCommand, CountsTheWholeMapAndCells) {
  EXPECT_EQ(waymark("inventory trees.gpkg -o all.csv").code, 1) << "trees on a line span no area";
  write("more.csv",
        "uid,x,y,height\na,440000,5400000,20\nb,440100,5400000,20\nc,440100,5400100,20\nd,440000,5400100,"
        "20\ne,440050,5400050,20\nf,440060,5400020,30\n");
  ASSERT_EQ(waymark("import more.csv -o more.gpkg --type tree --map-crs EPSG:32632").code, 0);
  const Outcome all = waymark("inventory more.gpkg -o all.csv --report all.html");
  ASSERT_EQ(all.code, 0) << all.text;
  EXPECT_THAT(all.text, HasSubstr("does not say which area was surveyed"));
  EXPECT_EQ(cell("all.csv", 0, "trees"), "6");
  EXPECT_THAT(read("all.html"), HasSubstr("</html>"));
  EXPECT_THAT(read("all.html"), HasSubstr("stems / ha of detected trees"));
  ASSERT_EQ(waymark("inventory more.gpkg --grid 50 -o grid.csv").code, 0);
  double hectares = 0;
  int trees = 0;
  for (std::size_t row = 0; !cell("grid.csv", row, "stand").empty(); ++row) {
    hectares += std::stod(cell("grid.csv", row, "area_ha"));
    trees += std::stoi(cell("grid.csv", row, "trees"));
  }
  EXPECT_NEAR(hectares, std::stod(cell("all.csv", 0, "area_ha")), 1e-8) << "cells are cut off at the edge";
  EXPECT_EQ(trees, 6);
}

TEST_F(InventoryCommand, StandsInAnotherCrsAreTransformed) {
  ASSERT_EQ(std::system(("ogr2ogr -q -t_srs EPSG:4326 '" + (folder / "degrees.gpkg").string() + "' '" +
                         (folder / "stands.geojson").string() + "'")
                            .c_str()),
            0);
  const Outcome reported = waymark("inventory trees.gpkg --stands degrees.gpkg -o out.csv");
  ASSERT_EQ(reported.code, 0) << reported.text;
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "area_ha")), 1, 1e-4);
  EXPECT_EQ(cell("out.csv", 0, "trees"), "10");
}

TEST_F(InventoryCommand, StandsThatMissTheMapAreOneWarning) {
  ASSERT_EQ(std::system(("ogr2ogr -q -a_srs EPSG:32633 '" + (folder / "far.gpkg").string() + "' '" +
                         (folder / "stands.geojson").string() + "'")
                            .c_str()),
            0);
  const Outcome reported = waymark("inventory trees.gpkg --stands far.gpkg -o out.csv");
  ASSERT_EQ(reported.code, 0) << reported.text;
  EXPECT_THAT(reported.text, HasSubstr("no stand has trees: check the CRS of the stands"));
  EXPECT_THAT(reported.text, Not(HasSubstr("stand west has no trees")));
}

TEST_F(InventoryCommand, LaserPointsInPlaceOfARasterAreNamed) {
  write("points.las", "LASF" + std::string(400, '\0'));
  const Outcome as_raster = waymark("trees --chm points.las -o t.gpkg");
  EXPECT_EQ(as_raster.code, 1);
  EXPECT_THAT(as_raster.text, HasSubstr("these are laser points, no raster"));
  EXPECT_THAT(as_raster.text, HasSubstr("--las"));
  const Outcome as_word = waymark("trees points.las -o t.gpkg");
  EXPECT_EQ(as_word.code, 2);
  EXPECT_THAT(as_word.text, HasSubstr("files are given by --chm, --dsm, --dtm, --las"));
}

TEST_F(InventoryCommand, TellsWhatIsWrongWithStandsAndGoesOn) {
  write("odd.geojson", R"({"type":"FeatureCollection",
 "crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},"features":[
 {"type":"Feature","properties":{"name":"a"},"geometry":{"type":"Polygon","coordinates":
  [[[440000,5400000],[440100,5400000],[440100,5400100],[440000,5400100],[440000,5400000]],
   [[440020,5400020],[440020,5400080],[440030,5400080],[440030,5400020],[440020,5400020]]]}},
 {"type":"Feature","properties":{"name":"b"},"geometry":{"type":"Polygon","coordinates":
  [[[440090,5400000],[440200,5400000],[440200,5400010],[440090,5400010],[440090,5400000]]]}},
 {"type":"Feature","properties":{"name":"bow"},"geometry":{"type":"Polygon","coordinates":
  [[[440300,5400000],[440400,5400100],[440400,5400000],[440300,5400100],[440300,5400000]]]}},
 {"type":"Feature","properties":{"name":"line"},"geometry":{"type":"LineString","coordinates":
  [[440000,5400000],[440100,5400000]]}},
 {"type":"Feature","properties":{"name":"none"},"geometry":null}]})");
  const Outcome reported = waymark("inventory trees.gpkg --stands odd.geojson -o out.csv");
  EXPECT_EQ(reported.code, 3) << reported.text;
  EXPECT_THAT(reported.text, HasSubstr("stands a and b overlap by 100.0"));
  EXPECT_THAT(reported.text, HasSubstr("stand b has no trees"));
  EXPECT_THAT(reported.text, HasSubstr("stand bow crosses itself: repaired"));
  EXPECT_THAT(reported.text, HasSubstr("stand line is a Line String, not a polygon"));
  EXPECT_THAT(reported.text, HasSubstr("stand none has no geometry"));
  EXPECT_NEAR(std::stod(cell("out.csv", 0, "area_ha")), 0.94, 1e-9);
  EXPECT_EQ(cell("out.csv", 0, "trees"), "9") << "one stands in the hole";
  EXPECT_EQ(cell("out.csv", 1, "stems_per_ha"), "0");
  EXPECT_EQ(cell("out.csv", 1, "lorey_height_m"), "");
  EXPECT_NEAR(std::stod(cell("out.csv", 2, "area_ha")), 0.5, 1e-9);
  EXPECT_THAT(read("out.csv"), Not(HasSubstr(",nan")));
}

TEST_F(InventoryCommand, RefusesWhatCannotBeCounted) {
  const auto refused = [&](const std::string& words, int code, const char* says) {
    const Outcome reported = waymark("inventory " + words);
    EXPECT_EQ(reported.code, code) << reported.text;
    EXPECT_THAT(reported.text, HasSubstr(says));
  };
  refused("trees.gpkg --stands stands.geojson -o out.txt", 2, "the output is a .csv or a .gpkg");
  refused("trees.gpkg --stands stands.geojson -o out.csv --report out.pdf", 2, "the report is an HTML page");
  refused("trees.gpkg --stands stands.geojson --grid 10 -o out.csv", 2, "exclude each other");
  refused("trees.gpkg --stands none.shp -o out.csv", 1, "no such file of stands");
  refused("trees.gpkg --stands trees.csv -o out.csv", 1, "no layer of polygons");
  refused("none.gpkg --stands stands.geojson -o out.csv", 1, "there is no such map");
  write("v.csv", "species,form_factor\noak,0.5\n");
  refused("trees.gpkg --stands stands.geojson --volume v.csv -o out.csv", 1, "none for all");
  write("rocks.csv", "uid,x,y,radius\na,1,2,3\n");
  ASSERT_EQ(waymark("import rocks.csv -o rocks.gpkg --type rock --map-crs EPSG:32632").code, 0);
  refused("rocks.gpkg --stands stands.geojson -o out.csv", 1, "the map has no trees");
  write("deg.csv", "uid,x,y,height\na,8,48,20\n");
  ASSERT_EQ(waymark("import deg.csv -o deg.gpkg --type tree --map-crs EPSG:4326").code, 0);
  refused("trees.gpkg --trees-at-once 0 -o out.csv", 2, "--trees-at-once = 0 is below 1");
  refused("trees.gpkg --trees-at-once 5 --grid -1 -o out.csv", 2,
          "--trees-at-once was replaced: use --memory");
  refused("trees.gpkg --memory 15 -o out.csv", 2, "--memory = 15 is outside [16, 10000000]");
  refused("deg.gpkg --stands stands.geojson -o out.csv", 1, "the map is in degrees");
  EXPECT_FALSE(fs::exists(folder / "out.csv")) << "nothing half-written";
}

TEST_F(InventoryCommand, AMadeForestIsTheSameEveryTimeAndIsFound) {
  write("forest.json", R"({"waymark_scenario": 1, "crs": "EPSG:32632", "seed": 3,
    "ground": {"cell": 2, "east": 440000, "north": 5400000, "up": 300},
    "forest": {"width": 80, "height": 60, "stands": 2, "density": 250, "conifers": 1, "pulses": 6}})");
  for (const char* out : {"one", "two"}) {
    const Outcome made = waymark(std::string("simulate forest.json -o ") + out);
    ASSERT_EQ(made.code, 0) << made.text;
  }
  for (const char* file : {"chm.tif", "dsm.tif", "dtm.tif", "points.las", "truth/landmarks.csv",
                           "truth/understory.csv", "stands.geojson", "job.json"}) {
    EXPECT_FALSE(read(std::string("one/") + file).empty()) << file;
    EXPECT_EQ(read(std::string("one/") + file), read(std::string("two/") + file)) << file;
  }
  const std::string las = read("one/points.las");
  EXPECT_EQ(las.substr(0, 4), "LASF");
  std::uint32_t start = 0;
  std::uint64_t count = 0;
  std::memcpy(&start, las.data() + 96, 4);
  std::memcpy(&count, las.data() + 247, 8);
  EXPECT_EQ(las.size(), start + 30 * count) << "as many points as the header says";
  const Outcome found = waymark("run one/job.json -o found.gpkg");
  ASSERT_EQ(found.code, 0) << found.text;
  EXPECT_THAT(geodb::validate_map(folder / "found.gpkg"), ::testing::IsEmpty());
  EXPECT_THAT(geodb::shape_layers(folder / "found.gpkg"), ::testing::Contains("crown"));
  const Outcome counted = waymark("inventory found.gpkg --stands one/stands.geojson -o stands.csv");
  ASSERT_EQ(counted.code, 0) << counted.text;
  EXPECT_EQ(cell("stands.csv", 1, "stand"), "2");
  EXPECT_GT(std::stod(cell("stands.csv", 0, "stems_per_ha_detected")), 100);
  EXPECT_GT(std::stod(cell("stands.csv", 0, "stems_per_ha")),
            1.2 * std::stod(cell("stands.csv", 0, "stems_per_ha_detected")))
      << "trees under others, which the air does not see";
  EXPECT_GT(std::stod(cell("stands.csv", 0, "stems_per_ha_se")), 30);

  // The same, whether all trees are in memory or the few about a stand.
  const auto layers = [&](const std::string& map) {
    std::ostringstream text;
    for (const char* layer : {"stand", "stand_tree"})
      for (const geodb::Shape& row : geodb::read_shape_layer(folder / map, layer).rows) {
        for (const AttributeValue& value : row.values)
          std::visit(
              [&](const auto& v) {
                if constexpr (!std::is_same_v<std::decay_t<decltype(v)>, std::monostate>) text << v;
                text << ' ';
              },
              value);
        text << row.parts.at(0).outer.at(0).transpose() << '\n';
      }
    return text.str();
  };
  for (const char* ground : {"--stands one/stands.geojson", "--grid 20", ""}) {
    ASSERT_EQ(waymark(std::string("inventory found.gpkg -o all.gpkg ") + ground).code, 0);
    ASSERT_EQ(waymark(std::string("inventory found.gpkg -o all.csv ") + ground).code, 0);
    const std::string expected = layers("all.gpkg");
    EXPECT_GT(expected.size(), 1000u);
    for (const char* held : {"1", "30"}) {
      const std::string some = std::string(" --trees-at-once ") + held + " " + ground;
      const Outcome reported = waymark("inventory found.gpkg -o some.gpkg" + some);
      ASSERT_EQ(reported.code, 0) << reported.text;
      EXPECT_EQ(layers("some.gpkg"), expected) << some;
      EXPECT_THAT(geodb::validate_map(folder / "some.gpkg"), ::testing::IsEmpty());
      ASSERT_EQ(waymark("inventory found.gpkg -o some.csv" + some).code, 0);
      EXPECT_EQ(read("some.csv"), read("all.csv")) << some;
    }
    fs::copy_file(folder / "found.gpkg", folder / "own.gpkg", fs::copy_options::overwrite_existing);
    ASSERT_EQ(waymark(std::string("inventory own.gpkg -o own.gpkg --trees-at-once 30 ") + ground).code, 0);
    EXPECT_EQ(layers("own.gpkg"), expected) << "written into the map it reads";
  }
}

}  // namespace
}  // namespace waymark::test
