// SPDX-License-Identifier: Apache-2.0
// `--aoi` of the commands that read tables, images and maps.
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

/// Trees of a grid of 10 x 10, 10 m apart, from (500000, 5200000) in UTM zone 32, and areas in degrees and in
/// the zone: x from 500000 to 500045, y from 5200000 to 5200095, which hold 50 of them.
class AreaOption : public testing::Test {
 protected:
  AreaOption() {
    std::string table = "x,y,height,diameter\n";
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 10; ++x)
        table += std::to_string(500000 + 10 * x) + "," + std::to_string(5200000 + 10 * y) + ",20,0.3\n";
    write_text(folder_ / "trees.csv", table);
    polygon("utm.geojson", "urn:ogc:def:crs:EPSG::32632",
            "[[499995,5199995],[500045,5199995],[500045,5200095],[499995,5200095],[499995,5199995]]");
    // The same corners, to 1e-7 degrees.
    EXPECT_EQ(bash("ogr2ogr -t_srs EPSG:4326 -lco COORDINATE_PRECISION=9 '" + folder_ / "degrees.geojson" +
                   "' '" + folder_ / "utm.geojson" + "'")
                  .code,
              0);
    polygon("far.geojson", "urn:ogc:def:crs:EPSG::32632",
            "[[510000,5199995],[510045,5199995],[510045,5200095],[510000,5199995]]");
    EXPECT_EQ(
        waymark({"import", folder_ / "trees.csv", "-o", map_, "--type", "tree", "--map-crs", "EPSG:32632"})
            .code,
        0);
  }
  void polygon(const std::string& name, const std::string& crs, const std::string& ring) {
    write_text(
        folder_ / name,
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + crs +
            R"("}},"features":[{"type":"Feature","properties":{"name":"a"},"geometry":{"type":"Polygon","coordinates":[)" +
            ring + "]}}]}");
  }
  std::int64_t count(const std::string& map) {
    const Outcome rows = waymark({"query", map, "--format", "csv"});
    EXPECT_EQ(rows.code, 0) << rows.err;
    return std::ranges::count(rows.out, '\n') - 1;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "trees.gpkg";
};

TEST_F(AreaOption, OfAnImportRejectsAndCountsRowsOutside) {
  for (const char* area : {"utm.geojson", "degrees.geojson"}) {
    const Outcome made = waymark({"import", folder_ / "trees.csv", "-o", folder_ / "part.gpkg", "--type",
                                  "tree", "--map-crs", "EPSG:32632", "--aoi", folder_ / area});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.err, AllOf(HasSubstr("100 rows, 50 landmarks, 50 rejected"),
                                HasSubstr("50 outside the area of interest")));
    EXPECT_EQ(count(folder_ / "part.gpkg"), 50);
  }
  const Outcome far = waymark({"import", folder_ / "trees.csv", "-o", folder_ / "none.gpkg", "--type", "tree",
                               "--map-crs", "EPSG:32632", "--aoi", folder_ / "far.geojson"});
  EXPECT_EQ(far.code, 1);
  EXPECT_THAT(far.err, HasSubstr("none of the 100 rows lies in the area of interest"));
}

TEST_F(AreaOption, OfRulesRejectsElementsOutside) {
  ASSERT_EQ(waymark({"export", map_, folder_ / "trees.fgb"}).code, 0);
  const Outcome rules = waymark({"import", folder_ / "trees.fgb", "-o", folder_ / "part.gpkg", "--rules",
                                 "trees", "--aoi", folder_ / "utm.geojson"});
  ASSERT_EQ(rules.code, 0) << rules.err;
  EXPECT_EQ(count(folder_ / "part.gpkg"), 50);
  EXPECT_THAT(rules.err, HasSubstr("50 outside the area of interest"));
}

TEST_F(AreaOption, OfAReportAndAWebMapTakesTheLandmarksInside) {
  const Outcome report =
      waymark({"report", map_, "-o", folder_ / "r.html", "--aoi", folder_ / "degrees.geojson"});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_THAT(text_of(folder_ / "r.html"), AllOf(HasSubstr("50"), HasSubstr("<title>Trees")));
  const Outcome web =
      waymark({"web", map_, "-o", folder_ / "site", "--aoi", folder_ / "utm.geojson", "--format", "json"});
  ASSERT_EQ(web.code, 0) << web.err;
  EXPECT_EQ(Json::parse(web.out)["landmarks"], 50);
  for (const char* command : {"report", "web"}) {
    const Outcome far = waymark({command, map_, "-o", folder_ / "x.html", "--aoi", folder_ / "far.geojson"});
    EXPECT_EQ(far.code, 1);
    EXPECT_THAT(far.err, HasSubstr("no landmark of the map lies in the area of interest"));
  }
}

TEST_F(AreaOption, OfAMergeCutsTheResult) {
  write_text(folder_ / "more.csv", "x,y,height,diameter\n500005,5200005,20,0.3\n500095,5200005,20,0.3\n");
  ASSERT_EQ(waymark({"import", folder_ / "more.csv", "-o", folder_ / "more.gpkg", "--type", "tree",
                     "--map-crs", "EPSG:32632"})
                .code,
            0);
  const Outcome made = waymark({"merge", map_, folder_ / "more.gpkg", "-o", folder_ / "m.gpkg", "--aoi",
                                folder_ / "utm.geojson", "--format", "json"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(Json::parse(made.out)["landmarks"], 51);
  EXPECT_THAT(made.err, HasSubstr("51 of 102 landmarks"));
  EXPECT_EQ(count(folder_ / "m.gpkg"), 51);
  EXPECT_EQ(waymark({"validate", folder_ / "m.gpkg"}).code, 0);
}

TEST_F(AreaOption, OfAnInventoryIsItsStand) {
  const Outcome made =
      waymark({"inventory", map_, "-o", folder_ / "s.csv", "--aoi", folder_ / "degrees.geojson"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("1 stands, 50 trees"));
  const Outcome both =
      waymark({"inventory", map_, "-o", folder_ / "s.csv", "--aoi", folder_ / "utm.geojson", "--grid", "50"});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--aoi exchanges the stands"));
}

TEST_F(AreaOption, OfADetectionDropsWhatLiesOutside) {
  // Bright discs with shadows every 40 pixels: rocks of an orthophoto of 0.1 m.
  GDALAllRegister();
  const std::string image = folder_ / "ortho.tif";
  {
    GDALDatasetUniquePtr set(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(image.c_str(), 400, 400,
                                                                                      1, GDT_Byte, nullptr));
    double where[6] = {500000, 0.1, 0, 5200040, 0, -0.1};
    set->SetGeoTransform(where);
    OGRSpatialReference utm;
    utm.importFromEPSG(32632);
    set->SetSpatialRef(&utm);
    std::vector<std::uint8_t> pixels(400 * 400);
    for (int y = 0; y < 400; ++y)
      for (int x = 0; x < 400; ++x) {
        const int u = x % 40 - 20, v = y % 40 - 20;
        int value = 120 + (x * 7 + y * 13) % 5;
        if (u * u + v * v <= 25) value = 200;
        if (u > 2 && u < 18 && std::abs(v) <= 4 && u * u + v * v > 25) value = 20;
        pixels[std::size_t(y * 400 + x)] = std::uint8_t(value);
      }
    ASSERT_EQ(set->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 400, 400, pixels.data(), 400, 400, GDT_Byte, 0,
                                              0, nullptr),
              CE_None);
  }
  const std::vector<std::string> words{
      "detect", "rocks", image, "-o", folder_ / "d.csv", "--sun-azimuth", "270", "--sun-elevation", "30"};
  const auto rows = [&] {
    const std::string text = text_of(folder_ / "d.csv");
    return std::ranges::count(text, '\n') - 1;
  };
  ASSERT_EQ(waymark(words).code, 0);
  const auto all = rows();
  ASSERT_GT(all, 60);
  polygon("left.geojson", "urn:ogc:def:crs:EPSG::32632",
          "[[500000,5200000],[500020,5200000],[500020,5200040],[500000,5200040],[500000,5200000]]");
  std::vector<std::string> inside = words;
  inside.insert(inside.end(), {"--aoi", folder_ / "left.geojson"});
  const Outcome made = waymark(inside);
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NEAR(double(rows()), double(all) / 2, 6);
  EXPECT_THAT(made.err, HasSubstr("outside the area of interest"));
  inside.back() = folder_ / "far.geojson";
  EXPECT_THAT(waymark(inside).err, HasSubstr("the area of interest lies off the image"));
  EXPECT_EQ(bash("gdal_translate -q -of PNG --config GDAL_PAM_ENABLED NO '" + image + "' '" +
                 folder_ / "plain.png" + "'")
                .code,
            0);
  const Outcome plain = waymark({"detect", "rocks", folder_ / "plain.png", "-o", folder_ / "d.csv",
                                 "--image-sun-angle", "180", "--aoi", folder_ / "left.geojson"});
  EXPECT_THAT(plain.err, HasSubstr("no area of interest applies"));
}

}  // namespace
}  // namespace waymark::test
