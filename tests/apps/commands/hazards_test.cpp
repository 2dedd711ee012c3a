// SPDX-License-Identifier: Apache-2.0
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Hazards : public testing::Test {
 protected:
  /// Level terrain of 0.5 m cells with a wall of 1 m at column 40, and a void.
  std::string wall(const std::string& crs = "EPSG:32632") {
    MadeDem dem{.columns = 80, .rows = 60};
    dem.crs = crs;
    dem.geotransform = {500000, 0.5, 0, 5200000, 0, -0.5};
    dem.height = [](int column, int row) {
      return column == 60 && row == 30 ? -9999.0 : column < 40 ? 100.0 : 101.0;
    };
    return make_dem(folder_ / "wall.tif", dem);
  }
  std::vector<float> band(const std::string& file, int number) {
    GDALAllRegister();
    const GDALDatasetUniquePtr set(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    EXPECT_TRUE(set);
    std::vector<float> cells(80 * 60);
    EXPECT_EQ(set->GetRasterBand(number)->RasterIO(GF_Read, 0, 0, 80, 60, cells.data(), 80, 60, GDT_Float32,
                                                   0, 0, nullptr),
              CE_None);
    return cells;
  }

  TempFolder folder_;
};

TEST_F(Hazards, WallIsAHazardAndTheVoidUnknown) {
  const Outcome made = waymark({"hazards", wall(), "-o", folder_ / "h.tif", "--height-sd", "0.02",
                                "--polygons", folder_ / "h.gpkg", "--nav2", folder_ / "h.yaml"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err,
              AllOf(HasSubstr("80 x 60 cells for rover"), HasSubstr("safe"), HasSubstr("--rock-cover")));
  const std::vector<float> classes = band(folder_ / "h.tif", 11);
  EXPECT_EQ(classes[30 * 80 + 39], 2);
  EXPECT_EQ(classes[30 * 80 + 60], 3);
  EXPECT_EQ(classes[30 * 80 + 20], 0);
  EXPECT_EQ(classes[0], 3);
  EXPECT_TRUE(std::isnan(band(folder_ / "h.tif", 10)[0]));
  EXPECT_THAT(text_of(folder_ / "h.qml"), HasSubstr("band=\"10\""));
  const std::string pgm = text_of(folder_ / "h.pgm");
  ASSERT_TRUE(pgm.starts_with("P5\n80 60\n255\n"));
  const std::string cells = pgm.substr(pgm.size() - 80 * 60);
  EXPECT_EQ(cells[30 * 80 + 39], 100);
  EXPECT_EQ(static_cast<unsigned char>(cells[0]), 255);
  EXPECT_THAT(text_of(folder_ / "h.yaml"),
              AllOf(HasSubstr("# Metres of EPSG:32632"), HasSubstr("mode: raw"), HasSubstr("resolution: 0.5"),
                    HasSubstr("origin: [500000, 5199970, 0]")));
  GDALAllRegister();
  const GDALDatasetUniquePtr set(GDALDataset::Open((folder_ / "h.gpkg").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(set);
  OGRLayer* layer = set->GetLayerByName("hazard");
  ASSERT_NE(layer, nullptr);
  double area = 0, expected = 0;
  for (const auto& feature : *layer)
    if (std::string(feature->GetFieldAsString("class")) == "hazard")
      area += feature->GetFieldAsDouble("area");
  for (const float c : classes) expected += c == 2 ? 0.25 : 0;
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(area, expected, 1e-6);
}

TEST_F(Hazards, OfACrsThatStretchesLengthsComeWithAWarning) {
  const std::string dem = wall("EPSG:3857");
  const Outcome made = waymark({"hazards", dem, "-o", folder_ / "h.tif"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("EPSG:3857 stretches lengths here, by 1.35"),
                              HasSubstr("gdalwarp -t_srs EPSG:32631 " + dem)));
  EXPECT_THAT(waymark({"hazards", wall(), "-o", folder_ / "u.tif"}).err,
              testing::Not(HasSubstr("stretches")));
}

TEST_F(Hazards, OfDemsInFeetForNav2AreInMetres) {
  const Outcome made =
      waymark({"hazards", wall("EPSG:2263"), "-o", folder_ / "h.tif", "--nav2", folder_ / "h.yaml"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(text_of(folder_ / "h.yaml"),
              AllOf(HasSubstr("# Metres, 0.304800609601 times x and y of EPSG:2263"),
                    HasSubstr("resolution: 0.152400304801\norigin: [152400.304801, 1584954.02591, 0]")));
}

TEST_F(Hazards, OfTheMapForNav2HazardsAloneAreObstacles) {
  const Outcome made = waymark(
      {"hazards", wall(), "-o", folder_ / "h.tif", "--height-sd", "0.2", "--nav2", folder_ / "h.yaml"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::vector<float> classes = band(folder_ / "h.tif", 11);
  const std::string pgm = text_of(folder_ / "h.pgm"), cells = pgm.substr(pgm.size() - 80 * 60);
  const std::vector<float> probability = band(folder_ / "h.tif", 10);
  std::size_t uncertain = 0, doubtful_hazards = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // Costmaps of Nav2 take only 100 for an obstacle (nav2_costmap_2d, lethal_cost_threshold).
    ASSERT_EQ(cells[i] == 100, classes[i] == 2) << i;
    if (classes[i] < 2) {
      ASSERT_EQ(cells[i], std::lround(100 * probability[i])) << i;
    }
    uncertain += classes[i] == 1, doubtful_hazards += classes[i] == 2 && probability[i] < 0.99;
  }
  EXPECT_GT(uncertain, 0u);
  EXPECT_GT(doubtful_hazards, 0u);
}

TEST_F(Hazards, OutsideTheAreaOfInterestIsUnknown) {
  write_text(folder_ / "west.geojson", R"({"type": "FeatureCollection",
    "crs": {"type": "name", "properties": {"name": "EPSG:32632"}}, "features": [{"type": "Feature", "properties": {},
    "geometry": {"type": "Polygon", "coordinates":
    [[[499000, 5190000], [500010, 5190000], [500010, 5210000], [499000, 5210000], [499000, 5190000]]]}}]})");
  ASSERT_EQ(waymark({"hazards", wall(), "-o", folder_ / "all.tif"}).code, 0);
  const Outcome made = waymark({"hazards", wall(), "-o", folder_ / "west.tif", "--aoi",
                                folder_ / "west.geojson", "--nav2", folder_ / "west.yaml"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::vector<float> all = band(folder_ / "all.tif", 11), west = band(folder_ / "west.tif", 11);
  const std::string pgm = text_of(folder_ / "west.pgm");
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(west[i], i % 80 < 20 ? all[i] : 3) << i;
    ASSERT_EQ(static_cast<unsigned char>(pgm[pgm.size() - 80 * 60 + i]) == 255, west[i] == 3) << i;
  }
}

TEST_F(Hazards, ADemWithoutACrsIsTakenWithOne) {
  const std::string dem = wall("");
  const Outcome refused = waymark({"hazards", dem, "-o", folder_ / "h.tif"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("pass --crs"));
  const Outcome made = waymark({"hazards", dem, "-o", folder_ / "h.tif", "--crs", "local"});
  EXPECT_EQ(made.code, 0) << made.err;
}

TEST_F(Hazards, BytesDoNotDependOnTilesAndThreads) {
  wall();
  std::vector<std::string> files;
  for (const auto& [tile, threads] : {std::pair("512", "1"), std::pair("16", "2"), std::pair("33", "2")}) {
    files.push_back(folder_ / (std::string(tile) + ".tif"));
    const Outcome made = waymark({"hazards", folder_ / "wall.tif", "-o", files.back(), "--tile-cells", tile,
                                  "--threads", threads, "--rock-cover", "0.1", "--height-sd", "0.02"});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  EXPECT_EQ(text_of(files[0]), text_of(files[1]));
  EXPECT_EQ(text_of(files[0]), text_of(files[2]));
}

TEST_F(Hazards, DegreesAreRefusedWithTheCure) {
  MadeDem dem{.columns = 20, .rows = 20};
  dem.crs = "EPSG:4326";
  dem.geotransform = {8, 0.001, 0, 47, 0, -0.001};
  dem.height = [](int column, int) { return double(column); };
  const Outcome made = waymark({"hazards", make_dem(folder_ / "d.tif", dem), "-o", folder_ / "h.tif"});
  EXPECT_EQ(made.code, 1);
  EXPECT_THAT(made.err, AllOf(HasSubstr("in degrees"), HasSubstr("gdalwarp -t_srs EPSG:32632")));
}

TEST_F(Hazards, BadRequestsAreRefused) {
  wall();
  const auto error = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"hazards", folder_ / "wall.tif", "-o", folder_ / "h.tif"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome made = waymark(words);
    EXPECT_EQ(made.code, 2) << made.err;
    return made.err;
  };
  EXPECT_THAT(error({"--vehicle", "rovr"}), HasSubstr("did you mean 'rover'?"));
  EXPECT_THAT(error({"--dem", "x.tif"}), HasSubstr("the input is a DEM itself"));
  EXPECT_THAT(error({"--uncertain", "0.9"}), HasSubstr("no increasing probabilities"));
  EXPECT_THAT(error({"--rock-cover", "7"}), HasSubstr("no fraction"));
  write_text(folder_ / "v.json", R"({"waymark_vehicle": 1, "supports": [{"x": 1, "y": 1, "diameter": 0.3},
    {"x": -1, "y": 1, "diameter": 0.3}, {"x": -1, "y": -1, "diameter": 0.3}]})");
  EXPECT_THAT(error({"--vehicle", folder_ / "v.json"}),
              AllOf(HasSubstr("has none opposite"), HasSubstr("v.json")));
}

TEST_F(Hazards, MapsWithoutHeightsAreRefused) {
  write_text(folder_ / "rocks.csv", "x,y,radius\n10,10,1\n20,10,2\n");
  ASSERT_EQ(waymark({"import", folder_ / "rocks.csv", "-o", folder_ / "m.gpkg", "--type", "rock", "--map-crs",
                     "local"})
                .code,
            0);
  const Outcome made = waymark({"hazards", folder_ / "m.gpkg", "-o", folder_ / "h.tif"});
  EXPECT_EQ(made.code, 1);
  EXPECT_THAT(made.err, AllOf(HasSubstr("the map has no heights"), HasSubstr("--dem")));
}

TEST_F(Hazards, RocksOfTheMapAreHazards) {
  wall("");
  write_text(folder_ / "rocks.csv", "x,y,radius,height\n500010,5199985,0.5,1\n500015,5199985,0.1,0.1\n");
  const Outcome imported = waymark(
      {"import", folder_ / "rocks.csv", "-o", folder_ / "m.gpkg", "--type", "rock", "--map-crs", "local"});
  ASSERT_EQ(imported.code, 0) << imported.err;
  const Outcome replaced = waymark({"hazards", folder_ / "m.gpkg", "--dem", folder_ / "wall.tif", "-o",
                                    folder_ / "h.tif", "--polygons", folder_ / "m.gpkg"});
  EXPECT_THAT(replaced.err, HasSubstr("the output would replace the input"));
  const Outcome made =
      waymark({"hazards", folder_ / "m.gpkg", "--dem", folder_ / "wall.tif", "-o", folder_ / "h.tif"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::vector<float> object = band(folder_ / "h.tif", 7);
  EXPECT_GT(object[30 * 80 + 20], 0.5);   // x = 500010.25
  EXPECT_LT(object[30 * 80 + 32], 0.01);  // 6 m off; the low rock is none
}

TEST_F(Hazards, AMapElsewhereIsRefused) {
  wall("");
  write_text(folder_ / "rocks.csv", "x,y,radius,height\n10,15,0.5,1\n15,10,0.1,0.1\n");
  ASSERT_EQ(waymark({"import", folder_ / "rocks.csv", "-o", folder_ / "m.gpkg", "--type", "rock", "--map-crs",
                     "local"})
                .code,
            0);
  const Outcome made =
      waymark({"hazards", folder_ / "m.gpkg", "--dem", folder_ / "wall.tif", "-o", folder_ / "h.tif"});
  EXPECT_EQ(made.code, 1);
  EXPECT_THAT(made.err, AllOf(HasSubstr("no landmark of the map lies on the DEM"), HasSubstr("covers x 5000"),
                              HasSubstr("the landmarks x 10 to 15, y 10 to 15 in local")));
}

TEST_F(Hazards, NegativeNumbersAreRefused) {
  wall("");
  for (const char* option : {"--height-sd", "--rock-cover", "--detection-limit", "--height-correlation"}) {
    const Outcome said =
        waymark({"hazards", folder_ / "wall.tif", "--crs", "local", "-o", folder_ / "h.tif", option, "-0.1"});
    EXPECT_EQ(said.code, 2) << option;
    EXPECT_THAT(said.err, HasSubstr(std::string(option))) << option;
  }
}

TEST_F(Hazards, VehiclesAreListedAndDescribed) {
  EXPECT_THAT(waymark({"vehicles"}).out,
              AllOf(HasSubstr("harvester"), HasSubstr("lander"), HasSubstr("rover")));
  EXPECT_THAT(waymark({"vehicles", "rover"}).out, AllOf(HasSubstr("max_slope"), HasSubstr("radius")));
  const auto file = nlohmann::json::parse(waymark({"vehicles", "lander", "--as", "json"}).out);
  EXPECT_EQ(file["supports"].size(), 4);
  EXPECT_TRUE(nlohmann::json::parse(waymark({"vehicles", "--as", "schema"}).out).contains("rover"));
}

}  // namespace
}  // namespace waymark::test
