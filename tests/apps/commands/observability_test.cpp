// SPDX-License-Identifier: Apache-2.0
// `waymark observability` through the program.
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A row of rocks from (0, 0) to (100, 0).
class ObservabilityCommand : public testing::Test {
 protected:
  ObservabilityCommand() {
    std::string rocks = "x,y,radius,height\n";
    for (int x = 0; x <= 100; x += 5) rocks += std::to_string(x) + ",0,0.5,0.6\n";
    write_text(folder_ / "rocks.csv", rocks);
    const Outcome made =
        waymark({"import", folder_ / "rocks.csv", "-o", map_, "--type", "rock", "--map-crs", "local"});
    EXPECT_EQ(made.code, 0) << made.err;
  }
  Outcome run(const std::vector<std::string>& more, const std::string& out = "info.tif") {
    std::vector<std::string> words{"observability",    map_,      "-o", folder_ / out, "--sensor",
                                   "horizontal_laser", "--range", "20", "--view",      "360"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  /// Value of a band at a position.
  double at(int band, double x, double y) {
    GDALAllRegister();
    const GDALDatasetUniquePtr set(GDALDataset::Open((folder_ / "info.tif").c_str(), GDAL_OF_RASTER));
    EXPECT_TRUE(set);
    double t[6];
    EXPECT_EQ(set->GetGeoTransform(t), CE_None);
    float value = 0;
    EXPECT_EQ(set->GetRasterBand(band)->RasterIO(GF_Read, static_cast<int>((x - t[0]) / t[1]),
                                                 static_cast<int>((y - t[3]) / t[5]), 1, 1, &value, 1, 1,
                                                 GDT_Float32, 0, 0, nullptr),
              CE_None);
    return static_cast<double>(value);
  }

  TempFolder folder_;
  const std::string map_ = folder_ / "m.gpkg";
};

TEST_F(ObservabilityCommand, IsBestAmongTheLandmarks) {
  const Outcome made = run({"--cell", "1"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("140 x 40 cells of 1 m"), HasSubstr("with a landmark in sight")));
  EXPECT_LT(at(1, 50.5, 5.5), 0.3);
  EXPECT_GT(at(1, 50.5, 19.5), at(1, 50.5, 5.5));
  EXPECT_GT(at(1, -19.5, 19.5), 5);  // the corner, from which none is seen
  EXPECT_EQ(at(3, -19.5, 19.5), 0);
  EXPECT_EQ(at(3, 50.5, 5.5), 7);  // x from 35 to 65
  EXPECT_GT(at(8, 50.5, 5.5), 0);
  EXPECT_THAT(text_of(folder_ / "info.qml"), HasSubstr("singlebandpseudocolor"));
}

TEST_F(ObservabilityCommand, BytesDependOnNeitherTilesNorThreads) {
  ASSERT_EQ(run({"--threads", "1"}, "a.tif").code, 0);
  ASSERT_EQ(run({"--threads", "2", "--tile-cells", "16"}, "b.tif").code, 0);
  EXPECT_EQ(text_of(folder_ / "a.tif"), text_of(folder_ / "b.tif"));
}

TEST_F(ObservabilityCommand, LandmarksBehindAHillAreNotSeen) {
  // A wall of 5 m along y = 8 hides the row from the north.
  std::string dem = "ncols 160\nnrows 60\nxllcorner -30\nyllcorner -30\ncellsize 1\n";
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 160; ++column)
      dem += std::string(30 - row == 9 ? "5" : "0") + (column == 159 ? "\n" : " ");
  write_text(folder_ / "hill.asc", dem);
  const Outcome open = run({"--cell", "1"});
  EXPECT_THAT(open.err, HasSubstr("terrain hides no landmark: --dem gives it"));
  EXPECT_EQ(at(3, 50.5, 15.5), 5);  // x from 40 to 60
  const Outcome made = run({"--cell", "1", "--dem", folder_ / "hill.asc", "--sensor-height", "0.5"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(at(3, 50.5, 15.5), 0);
  EXPECT_GT(at(1, 50.5, 15.5), 5) << "odometry alone";
  EXPECT_EQ(at(3, 50.5, 5.5), 7);
  const Outcome tiles = run({"--cell", "1", "--dem", folder_ / "hill.asc", "--sensor-height", "0.5",
                             "--threads", "2", "--tile-cells", "16"},
                            "tiles.tif");
  ASSERT_EQ(tiles.code, 0) << tiles.err;
  EXPECT_EQ(text_of(folder_ / "info.tif"), text_of(folder_ / "tiles.tif"));
}

TEST_F(ObservabilityCommand, CoversTheAreaOfInterest) {
  write_text(folder_ / "area.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
    "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[[40, -10], [60, -10], [60, 10], [40, -10]]]}}]})");
  ASSERT_EQ(run({"--cell", "1"}).code, 0);
  const double whole = at(1, 55.5, -5.5);
  const Outcome made = run({"--cell", "1", "--aoi", folder_ / "area.geojson"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("20 x 20 cells of 1 m"));
  EXPECT_EQ(at(1, 55.5, -5.5), whole);
  EXPECT_TRUE(std::isnan(at(1, 41.5, 5.5))) << "in the box, outside the triangle";
  write_text(folder_ / "far.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
    "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[[400, -10], [600, -10], [600, 10], [400, -10]]]}}]})");
  EXPECT_THAT(run({"--aoi", folder_ / "far.geojson"}).err,
              HasSubstr("no landmark can be seen from the area of interest"));
}

// Mountain tops of hills 12 km across: cells of 2 m, and lines of sight sampled each half metre, took hours.
TEST(ObservabilityOfMountainTops, EndsWithAMillionCellsAtMost) {
  TempFolder folder;
  MadeDem dem{.columns = 400, .rows = 400};
  dem.crs = "EPSG:32632";
  dem.geotransform = {600000, 30, 0, 5200000, 0, -30};
  dem.height = [](int column, int row) {
    return 800 + 300 * std::sin(0.06 * column) * std::cos(0.05 * row) +
           40 * std::sin(0.31 * column + 0.2 * row);
  };
  make_dem(folder / "dem.tif", dem);
  ASSERT_EQ(waymark({"peaks", folder / "dem.tif", "-o", folder / "m.gpkg", "--with-dem"}).code, 0);
  const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"observability", folder / "m.gpkg", "-o",       folder / out,
                                   "--sensor",      "bearing_camera",  "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome made = waymark(words);
    EXPECT_EQ(made.code, 0) << made.err;
    return nlohmann::json::parse(made.out);
  };
  const auto near = run("near.tif", {});  // 100 m: few cells see a landmark
  EXPECT_LE(near["columns"].get<double>() * near["rows"].get<double>(), 1e6);
  EXPECT_EQ(near["cell_m"], 20);
  EXPECT_GT(near["seen"], 0);
  const auto far = run("far.tif", {"--range", "12000", "--cell", "200"});
  EXPECT_GT(far["seen"], 0.5);
  const auto open = run("open.tif", {"--range", "12000", "--cell", "200", "--sensor-height", "1000"});
  EXPECT_GT(open["seen"], far["seen"]) << "terrain hides fewer landmarks from above";
}

TEST_F(ObservabilityCommand, SaysWhatCannotWork) {
  EXPECT_THAT(run({}, "info.png").err, HasSubstr("does not end in .tif"));
  EXPECT_THAT(run({"--cell", "0"}).err, HasSubstr("outside [0.1, 1000] m"));
  EXPECT_EQ(run({"--cell", "0"}).code, 2);
  EXPECT_THAT(run({"--drive", "0"}).err, HasSubstr("--drive"));
  EXPECT_THAT(waymark({"observability", folder_ / "none.gpkg", "-o", folder_ / "x.tif", "--sensor",
                       "horizontal_laser"})
                  .err,
              HasSubstr("none.gpkg"));
  write_text(folder_ / "far.csv", "x,y,radius,height\n9,48,0.5,0.6\n");
  ASSERT_EQ(waymark({"import", folder_ / "far.csv", "-o", folder_ / "far.gpkg", "--type", "rock", "--map-crs",
                     "EPSG:4326"})
                .code,
            0);
  const Outcome degrees = waymark(
      {"observability", folder_ / "far.gpkg", "-o", folder_ / "x.tif", "--sensor", "horizontal_laser"});
  EXPECT_EQ(degrees.code, 1);
  EXPECT_THAT(degrees.err, HasSubstr("in degrees"));
}

}  // namespace
}  // namespace waymark::test
