// SPDX-License-Identifier: Apache-2.0
// Images, poses and suns that cannot be used, through the program: what is wrong is said, the rest goes on.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A grey picture with three rocks, their shadows to the right.
std::string rocks_picture() {
  constexpr int side = 96;
  std::string pixels;
  std::uint32_t state = 7;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      state = state * 1664525u + 1013904223u;
      int value = 120 + static_cast<int>(state >> 29);
      for (const auto& [cx, cy] : {std::pair{24, 30}, {60, 50}, {70, 20}}) {
        if (std::hypot((x - cx - 4) / 5.0, (y - cy) / 3.0) < 1) value = 20;
        if (std::hypot(x - cx + 1, y - cy) < 3 && x < cx + 1) value = 190;
      }
      pixels += static_cast<char>(static_cast<unsigned char>(value));
    }
  return "P5 96 96 255\n" + pixels;
}

std::string flat_picture(int side, char value) {
  return "P5 " + std::to_string(side) + ' ' + std::to_string(side) + " 255\n" +
         std::string(static_cast<std::size_t>(side * side), value);
}

/// Four images of a plain from 30 m above it, and the job that maps their rocks.
class BadLanding : public testing::Test {
 protected:
  BadLanding() {
    for (const char* name : {"a.pgm", "b.pgm", "c.pgm", "d.pgm"}) {
      pictures_[name] = rocks_picture();
      json image = json::parse(R"({"camera": "k", "rotation": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
                                   "rotation_sd": 0.02, "position_sd": 0.1})");
      image["name"] = name;
      image["centre"] = {2.0 * (name[0] - 'a'), 0, 30};
      cameras_["images"].push_back(image);
    }
  }

  Outcome run() {
    std::filesystem::create_directories(folder_ / "images");
    for (const auto& [name, picture] : pictures_) write_text(folder_ / ("images/" + name), picture);
    write_text(folder_ / "cameras.json", cameras_.dump(1));
    std::string heights = "ncols 60\nnrows 60\nxllcorner -60\nyllcorner -60\ncellsize 2\n";
    for (int i = 0; i < 60 * 60; ++i) heights += i % 60 == 59 ? "0\n" : "0 ";
    write_text(folder_ / "dem.asc", heights);
    write_text(folder_ / "job.json", R"({"name": "bad", "stages": [
      {"stage": "load_dem", "files": ["dem.asc"], "crs": "local"},
      {"stage": "load_images", "cameras": "cameras.json"}, {"stage": "rocks_from_shadows"},
      {"stage": "project_to_ground"}, {"stage": "reject_implausible"},
      {"stage": "reject_terrain_shadows"}, {"stage": "reject_rim_shadows"}, {"stage": "align_images"},
      {"stage": "merge_observations"}, {"stage": "value_landmarks"}]})");
    return waymark({"run", folder_ / "job.json", "-o", map_});
  }
  /// What is said where the rest goes on; `code` as expected and a map that holds rocks of the other images.
  std::string goes_on(int code) {
    const Outcome said = run();
    EXPECT_EQ(said.code, code) << said.err;
    EXPECT_EQ(waymark({"validate", map_}).code, 0);
    EXPECT_THAT(waymark({"query", map_, "--format", "json"}).out,
                AllOf(HasSubstr("\"rock\""), Not(HasSubstr("nan"))));
    return said.err;
  }
  json& image(std::size_t number) { return cameras_["images"][number]; }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg";
  std::map<std::string, std::string> pictures_;
  json cameras_ = json::parse(R"({"waymark_cameras": 1, "frame": {"axes": "grid", "crs": "local"},
    "sun": {"azimuth": 270, "elevation": 35},
    "cameras": {"k": {"columns": 96, "rows": 96, "fx": 96, "fy": 96, "cx": 47.5, "cy": 47.5}}})");
};

TEST_F(BadLanding, GoodOnesMakeAMap) {
  EXPECT_THAT(goes_on(0), Not(HasSubstr("failed")));
}

TEST_F(BadLanding, SunBelowTheHorizonIsRefused) {
  cameras_["sun"]["elevation"] = -5;
  const Outcome said = run();
  EXPECT_EQ(said.code, 1);
  EXPECT_FALSE(std::filesystem::exists(map_));
  EXPECT_THAT(said.err, AllOf(HasSubstr("the sun is below the horizon: elevation -5"),
                              HasSubstr("cameras.json, at /sun/elevation"), HasSubstr("(0, 90]")));
}

TEST_F(BadLanding, ImageWithoutPose) {
  image(1).erase("centre"), image(1).erase("rotation");
  EXPECT_THAT(goes_on(3), AllOf(HasSubstr("image 'b.pgm' has neither a pose nor a georeference"),
                                HasSubstr("add it to the camera file")));
}

TEST_F(BadLanding, CameraUnderTheGround) {
  image(1)["centre"][2] = -10;
  EXPECT_THAT(goes_on(0), AllOf(HasSubstr("the camera is 10 m under the ground"), HasSubstr("datum")));
}

TEST_F(BadLanding, CameraLooksAtTheSky) {
  image(1)["rotation"] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THAT(goes_on(0), AllOf(HasSubstr("the camera looks at the sky"), HasSubstr("b.pgm")));
}

TEST_F(BadLanding, ImageOutsideTheDem) {
  image(1)["centre"][0] = 5000;
  EXPECT_THAT(goes_on(0), AllOf(HasSubstr("its view misses the DEM's extent"), HasSubstr("b.pgm")));
}

TEST_F(BadLanding, BlackSaturatedAndOnePixelImages) {
  pictures_["b.pgm"] = flat_picture(96, 0);
  pictures_["c.pgm"] = flat_picture(96, static_cast<char>(255));
  pictures_["d.pgm"] = flat_picture(1, 7);
  EXPECT_THAT(goes_on(0),
              AllOf(HasSubstr("all pixels of the image are 0"), HasSubstr("all pixels of the image are 255"),
                    HasSubstr("the image has 1 x 1 pixels: too small")));
}

TEST_F(BadLanding, OfTwoImagesOfOneNameNeitherIsPlaced) {
  image(1)["name"] = "a.pgm";
  pictures_.erase("b.pgm");
  EXPECT_THAT(goes_on(3), HasSubstr("two images are named 'a.pgm': neither pose is used"));
}

TEST_F(BadLanding, HalfTheImagesMissing) {
  pictures_.erase("b.pgm"), pictures_.erase("d.pgm");
  EXPECT_THAT(goes_on(3), AllOf(HasSubstr("b.pgm: there is no such file"),
                                HasSubstr("d.pgm: there is no such file"), HasSubstr("failed")));
}

}  // namespace
}  // namespace waymark::test
