// SPDX-License-Identifier: Apache-2.0
// Maps in other programs: GDAL's GeoPackage validator must report no errors; SpatiaLite, QGIS and the npm
// GeoPackage reader must read them if they are installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geodb/map_editor.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMars = "IAU_2015:49910";  // equidistant cylindrical

MapContents rich_map(const std::string& crs) {
  MapContents map = scattered({.crs = crs});
  map.types.add({.name = "boulder",
                 .summary = "A type without landmarks",
                 .features = {{"radius", "m", Scale::ratio, 0, 9, ""}}});
  map.dem_coverage = ramp_dem(map.crs, 700, 500);
  return map;
}

void expect_valid(const std::filesystem::path& map) {
  const auto result =
      run_program("/usr/bin/python3 -m osgeo_utils.samples.validate_gpkg -k --extra --warning-as-error '" +
                  map.string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(result.output, "");
}

class OtherReaders : public ::testing::TestWithParam<std::string> {};

TEST_P(OtherReaders, ValidateGpkgFindsNothing) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", rich_map(GetParam()), {.empty_tables = {"boulder"}});
  expect_valid(folder / "map.gpkg");
}

TEST_P(OtherReaders, ValidateGpkgFindsNothingAfterEdits) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", rich_map(GetParam()));
  MapEditor editor = MapEditor::open(folder / "map.gpkg");
  Landmark landmark = *editor.map().find("lp-3");
  landmark.position.xyz.x() += 1e6;
  editor.update(landmark);
  landmark.uid = "lp-new";
  editor.insert(landmark);
  editor.remove("lp-5");
  expect_valid(folder / "map.gpkg");
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind, OtherReaders,
                         ::testing::Values("EPSG:32632", "EPSG:4326", kMars,
                                           "+proj=stere +lat_0=90 +R=1737400", ""));

TEST(OtherReaders, ValidateGpkgFindsNothingInAnEmptyMap) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({.landmarks = 0}));
  expect_valid(folder / "map.gpkg");
  write_map(folder / "nothing.gpkg", {});
  expect_valid(folder / "nothing.gpkg");
}

TEST(OtherReaders, OgrSeesLayersFieldsAndCrs) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", rich_map(kMars));
  const auto ogr = run_program("ogrinfo -so '" + (folder / "map.gpkg").string() + "' lamp_post");
  EXPECT_EQ(ogr.exit_code, 0);
  EXPECT_THAT(ogr.output, HasSubstr("Geometry: 3D Point"));
  EXPECT_THAT(ogr.output, HasSubstr("Feature Count: 1000"));
  EXPECT_THAT(ogr.output, HasSubstr("ID[\"IAU\",49910,2015]"));
  EXPECT_THAT(ogr.output, HasSubstr("height_sd: Real"));
  EXPECT_THAT(ogr.output, HasSubstr("fixtures: Integer64"));
  for (const char* complaint : {"Warning", "ERROR"}) EXPECT_THAT(ogr.output, Not(HasSubstr(complaint)));
  const auto view = run_program("ogrinfo -so '" + (folder / "map.gpkg").string() + "' landmark");
  EXPECT_THAT(view.output, HasSubstr("Feature Count: 1000"));
}

TEST(OtherReaders, GdalReadsTheCoverage) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", rich_map("EPSG:32632"));
  const auto info = run_program("gdalinfo -mm 'GPKG:" + (folder / "map.gpkg").string() + ":dem'");
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.output, HasSubstr("Size is 700, 500"));
  EXPECT_THAT(info.output, HasSubstr("Origin = (400000.000000000000000,5100000.000000000000000)"));
  EXPECT_THAT(info.output, HasSubstr("Pixel Size = (30.000000000000000,-30.000000000000000)"));
  EXPECT_THAT(info.output, HasSubstr("Computed Min/Max=5.000,499699.000"));
  EXPECT_THAT(info.output, HasSubstr("Unit Type: m"));
  for (const char* complaint : {"Warning", "ERROR"}) EXPECT_THAT(info.output, Not(HasSubstr(complaint)));
  const auto cell =
      run_program("gdallocationinfo -valonly 'GPKG:" + (folder / "map.gpkg").string() + ":dem' 300 400");
  EXPECT_EQ(cell.output, "400300\n");
}

bool available(const std::string& command_line) {
  return run_program(command_line).exit_code == 0;
}

TEST(OtherReaders, OgrEditsThroughOurTriggers) {
  const TemporaryFolder folder;
  const std::string map = (folder / "map.gpkg").string();
  write_map(map, scattered({}));
  const auto edit = run_program("ogrinfo '" + map + "' -sql \"DELETE FROM lamp_post WHERE uid = 'lp-1'\"");
  EXPECT_EQ(edit.exit_code, 0) << edit.output;
  EXPECT_EQ(query_text(map, "SELECT count(*) FROM rtree_lamp_post_geom"), "999");
}

TEST(OtherReaders, SpatialiteReadsTheGeometries) {
  if (!available("sqlite3 :memory: \"SELECT load_extension('mod_spatialite')\""))
    GTEST_SKIP() << "needs sqlite3 and libsqlite3-mod-spatialite";
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  const auto result = run_program("sqlite3 -readonly '" + (folder / "map.gpkg").string() +
                                  "' \"SELECT load_extension('mod_spatialite')\" "
                                  "\"SELECT count(*) FROM lamp_post WHERE ST_IsValid(GeomFromGPB(geom)) = 1 "
                                  "AND ST_Is3D(GeomFromGPB(geom))\"");
  EXPECT_THAT(result.output, HasSubstr("1000"));
}

TEST(OtherReaders, QgisDrawsTheLayerInOurStyle) {
  if (!available("/usr/bin/python3 -c 'import qgis.core'")) GTEST_SKIP() << "needs python3-qgis";
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", rich_map(kMars));
  const auto result = run_program("QT_QPA_PLATFORM=offscreen /usr/bin/python3 " WAYMARK_SOURCE_DIR
                                  "/tests/geodb/open_in_qgis.py '" +
                                  (folder / "map.gpkg").string() + "' lamp_post");
  EXPECT_THAT(result.output, HasSubstr("valid: True"));
  EXPECT_THAT(result.output, HasSubstr("crs: IAU_2015:49910"));
  EXPECT_THAT(result.output, HasSubstr("colour: #d0a020"));
  EXPECT_THAT(result.output, HasSubstr("labels: True"));
  EXPECT_THAT(result.output, HasSubstr("alias of height: Height (m)"));
  EXPECT_THAT(result.output, HasSubstr("display name: Lamp post 8 m"));
  EXPECT_THAT(result.output, HasSubstr("map tip: <b>[% coalesce('Lamp post ' ||"));
  EXPECT_THAT(result.output, HasSubstr("added: True, named: True"));
  EXPECT_THAT(result.output, HasSubstr("label: round(\"height\""));
  EXPECT_THAT(result.output, HasSubstr("size: 1.6 + coalesce(log10(1 + max(0, \"height\")), 0)"));
}

TEST(OtherReaders, NpmGeopackageReadsTheRows) {
  const std::string script = WAYMARK_SOURCE_DIR "/tests/geodb/read_with_npm.js";
  if (!available("node -e \"require.resolve('@ngageoint/geopackage')\""))
    GTEST_SKIP() << "needs node and NODE_PATH with @ngageoint/geopackage 4 and better-sqlite3: see "
                 << script;
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg",
            scattered({.crs = "EPSG:4326", .min_x = 10, .min_y = 40, .max_x = 11, .max_y = 41}));
  const auto result = run_program("node " + script + " '" + (folder / "map.gpkg").string() + "' lamp_post");
  EXPECT_THAT(result.output, HasSubstr("faults: 0\nrows: 1000\nwith z: 1000\n"));
}

}  // namespace
}  // namespace waymark::test
