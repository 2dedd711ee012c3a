// SPDX-License-Identifier: Apache-2.0
// `waymark reconstruct` through the program: products, the map, and what is said of input that cannot work.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/apps/made_flight.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Six images of 200 x 200 pixels, simulated once.
const fs::path& flight() {
  static const TempFolder folder;
  static const fs::path site = simulate_flight(folder.path(), {.pixels = 200});
  return site;
}

class ReconstructCommand : public testing::Test {
 protected:
  // The cameras of the flight, changed.
  std::string cameras(const std::function<void(json&)>& change) {
    json file = json::parse(text_of(flight() / "truth/cameras.json"));
    change(file);
    write_text(folder_ / "cameras.json", file.dump());
    return folder_ / "cameras.json";
  }
  Outcome run(const std::string& cameras, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"reconstruct",  (flight() / "images").string(), "--cameras", cameras, "-o",
                                   folder_ / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  TempFolder folder_;
};

TEST_F(ReconstructCommand, MakesTheMapInOneCommand) {
  const Outcome made =
      run((flight() / "truth/cameras.json").string(), {"--map-landmarks", folder_ / "map.gpkg"});
  ASSERT_EQ(made.code, 0) << made.err;
  for (const char* file :
       {"out/cameras.json", "out/dem.tif", "out/orthophoto.tif", "out/job.json", "map.gpkg"})
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  EXPECT_EQ(waymark({"validate", folder_ / "map.gpkg"}).code, 0);
  const Outcome again = waymark({"run", folder_ / "out/job.json", "-o", folder_ / "again.gpkg"});
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST_F(ReconstructCommand, StopsAtTheStageAskedAndStartsAtACoarseDem) {
  const Outcome poses = run((flight() / "truth/cameras.json").string(), {"--until", "poses"});
  ASSERT_EQ(poses.code, 0) << poses.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/cameras.json"));
  EXPECT_FALSE(fs::exists(folder_ / "out/dem.tif"));
  const Outcome dem =
      run(folder_ / "out/cameras.json", {"--until", "dem", "--dem", (flight() / "dem.tif").string()});
  ASSERT_EQ(dem.code, 0) << dem.err;
  EXPECT_THAT(dem.err, HasSubstr("% measured"));
  EXPECT_TRUE(fs::exists(folder_ / "out/dem.tif"));
  EXPECT_FALSE(fs::exists(folder_ / "out/orthophoto.tif"));
}

// Edges of a raster: west, south, east, north.
std::array<double, 4> edges_of(const std::string& raster) {
  const json corners = json::parse(bash("gdalinfo -json '" + raster + "'").out)["cornerCoordinates"];
  return {corners["lowerLeft"][0], corners["lowerLeft"][1], corners["upperRight"][0],
          corners["upperRight"][1]};
}

TEST_F(ReconstructCommand, AnAreaOfInterestCropsTheProducts) {
  const std::string truth = (flight() / "truth/cameras.json").string(), area = folder_ / "area.geojson";
  ASSERT_EQ(run(truth, {"--cell", "1"}).code, 0);
  const auto [west, south, east, north] = edges_of(folder_ / "out/dem.tif");
  fs::rename(folder_ / "out", folder_ / "whole");
  const auto write_area = [&](double x0, double y0, double x1, double y1) {
    write_text(
        area, json{{"type", "Polygon"}, {"coordinates", {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}}}}}
                  .dump());
  };
  // A box of the middle that begins and ends within cells.
  const double x0 = west + 0.4 * (east - west), x1 = west + 0.6 * (east - west);
  const double y0 = south + 0.4 * (north - south), y1 = south + 0.6 * (north - south);
  write_area(x0, y0, x1, y1);
  const Outcome made = run(truth, {"--cell", "1", "--aoi", area});
  ASSERT_EQ(made.code, 0) << made.err;
  for (const char* file : {"out/dem.tif", "out/orthophoto.tif"}) {
    const auto [left, bottom, right, top] = edges_of(folder_ / file);
    for (const auto& [wanted, is] : {std::pair(x0, left), {y0, bottom}, {-x1, -right}, {-y1, -top}}) {
      EXPECT_LE(is, wanted + 1e-6) << file;
      EXPECT_GT(is, wanted - 1 - 1e-6) << file << ": the cell that the edge lies in";
    }
  }
  std::vector<double> differences;
  for (double u = 0.2; u < 0.9; u += 0.2)
    for (double v = 0.2; v < 0.9; v += 0.2) {
      const std::string at = std::to_string(x0 + u * (x1 - x0)) + " " + std::to_string(y0 + v * (y1 - y0));
      const auto height = [&](const std::string& dem) {
        return bash("gdallocationinfo -valonly -b 1 -geoloc '" + dem + "' " + at).out;
      };
      const std::string part = height(folder_ / "out/dem.tif"), whole = height(folder_ / "whole/dem.tif");
      ASSERT_FALSE(part.empty() || whole.empty()) << at;
      differences.push_back(std::abs(std::stod(part) - std::stod(whole)));
    }
  std::ranges::sort(differences);
  // Half a pixel on the ground, 2 x 90 m x tan 30 deg / 200: the cells outside no longer smooth those inside.
  EXPECT_LT(differences[differences.size() / 2], 0.26);

  write_area(east + 500, south, east + 600, north);
  const Outcome off = run(truth, {"--aoi", area});
  EXPECT_EQ(off.code, 1);
  EXPECT_THAT(off.err, HasSubstr("the area of interest does not meet the terrain that two images see"));
  const Outcome poses = run(truth, {"--until", "poses", "--aoi", area});
  EXPECT_EQ(poses.code, 2);
  EXPECT_THAT(poses.err, HasSubstr("--aoi limits DEM and orthophoto, but --until poses makes none"));
}

TEST_F(ReconstructCommand, OneViewIsTooFew) {
  const Outcome one = run(cameras([](json& file) {
    for (std::size_t i = 1; i < file["images"].size(); ++i)
      file["images"][i].erase("centre"), file["images"][i].erase("rotation");
  }));
  EXPECT_EQ(one.code, 1);
  EXPECT_THAT(one.err, HasSubstr("heights need two images with poses, but 1 of 6 images has one"));
}

TEST_F(ReconstructCommand, AnImageWithoutPoseIsCounted) {
  const Outcome made =
      run(cameras([](json& file) { file["images"][2].erase("centre"), file["images"][2].erase("rotation"); }),
          {"--until", "poses", "--format", "json"});
  EXPECT_EQ(made.code, 3);
  EXPECT_EQ(json::parse(made.out)["failed"], 1);
  EXPECT_THAT(made.err,
              HasSubstr(std::string(json::parse(text_of(folder_ / "cameras.json"))["images"][2]["name"])));
}

TEST_F(ReconstructCommand, ImagesWithoutOverlapShareNoTerrain) {
  const Outcome apart = run(cameras([](json& file) {
    double x = 0;
    for (json& image : file["images"]) image["centre"][0] = x += 5000;
  }));
  EXPECT_EQ(apart.code, 1);
  EXPECT_THAT(apart.err, HasSubstr("share"));
}

TEST_F(ReconstructCommand, CamerasBelowTheCoarseDemAreNamed) {
  const Outcome below = run(cameras([](json& file) {
                              for (json& image : file["images"]) image["centre"][2] = -200;
                            }),
                            {"--dem", (flight() / "dem.tif").string()});
  EXPECT_EQ(below.code, 1);
  EXPECT_THAT(below.err, HasSubstr("m below the coarse DEM"));
  EXPECT_THAT(below.err, HasSubstr("different zeros"));
}

TEST_F(ReconstructCommand, ACoarseDemElsewhereIsRefused) {
  const Outcome away = run(cameras([](json& file) {
                             for (json& image : file["images"])
                               image["centre"][0] = double(image["centre"][0]) + 1e5;
                           }),
                           {"--dem", (flight() / "dem.tif").string()});
  EXPECT_EQ(away.code, 1);
  EXPECT_THAT(away.err, HasSubstr("the coarse DEM has no height below any of the images"));
}

TEST_F(ReconstructCommand, BlackImagesAreNamed) {
  fs::create_directory(folder_ / "black");
  const json file = json::parse(text_of(flight() / "truth/cameras.json"));
  for (const json& image : file["images"])
    write_text(folder_ / ("black/" + std::string(image["name"])),
               "P5 200 200 255\n" + std::string(40000, '\0'));
  const Outcome black = waymark({"reconstruct", folder_ / "black", "--cameras",
                                 (flight() / "truth/cameras.json").string(), "-o", folder_ / "out"});
  EXPECT_EQ(black.code, 1);
  EXPECT_THAT(black.err, HasSubstr("6 of 6 images have no contrast"));
}

TEST_F(ReconstructCommand, DegreesAndBadOptionsAreUsage) {
  const std::string good = (flight() / "truth/cameras.json").string();
  const Outcome degrees =
      run(cameras([](json& file) { file["frame"].erase("crs"); }), {"--crs", "EPSG:4326"});
  EXPECT_NE(degrees.code, 0);
  EXPECT_THAT(degrees.err, HasSubstr("degrees"));
  const Outcome cell = run(good, {"--cell", "-1"});
  EXPECT_EQ(cell.code, 2);
  EXPECT_THAT(cell.err, HasSubstr("--cell -1 is not a size in metres"));
  const Outcome fine = run(good, {"--cell", "0.0001"});
  EXPECT_EQ(fine.code, 2);
  EXPECT_THAT(fine.err, HasSubstr("million cells"));
  const Outcome map = run(good, {"--until", "dem", "--map-landmarks", folder_ / "map.gpkg"});
  EXPECT_EQ(map.code, 2);
  EXPECT_THAT(map.err, HasSubstr("--until stops before"));
  const Outcome none = waymark({"reconstruct", (flight() / "images").string(), "-o", folder_ / "out"});
  EXPECT_EQ(none.code, 1);  // poses of six small pictures without GPS have no scale
  EXPECT_THAT(none.err, HasSubstr("heights need poses in metres"));
}

}  // namespace
}  // namespace waymark::test
