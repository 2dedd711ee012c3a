// SPDX-License-Identifier: Apache-2.0
// `waymark reconstruct --map`: pictures without positions are placed in an orthophoto.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/apps/photo_flight.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Orthophoto of the ground that grid_flight() shows.
const fs::path& orthophoto() {
  static const TempFolder folder;
  static const fs::path file = [] {
    const Outcome made = waymark({"reconstruct", (grid_flight() / "images").string(), "--cameras",
                                  (grid_flight() / "truth/cameras.json").string(), "-o", folder / "site"});
    EXPECT_EQ(made.code, 0) << made.err;
    return fs::path(folder / "site/orthophoto.tif");
  }();
  return file;
}

using Position = std::array<double, 3>;

Position position_of(const json& values) {
  return {values[0], values[1], values[2]};
}

double in_plan(const Position& a, const Position& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

double distance(const Position& a, const Position& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Standard deviation of a coordinate of the centre of an image in a camera file.
double sd_of(const json& image, std::size_t k) {
  return std::sqrt(double(image["covariance"][3 + k][3 + k]));
}

class ReconstructInMapImage : public PhotoFlight {
 protected:
  Outcome run(const std::string& map, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"reconstruct", folder_ / "images",
                                   "--lens",      (grid_flight() / "truth/cameras.json").string(),
                                   "--map",       map,
                                   "--until",     "poses",
                                   "-o",          folder_ / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
};

TEST_F(ReconstructInMapImage, PosesAreThoseOfTheMap) {
  write_good(6);
  const Outcome made = run(orthophoto().string());
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("placed in the map image"), HasSubstr("frame: local"),
                              HasSubstr("heights are above the mean level of the terrain")));
  const json found = json::parse(text_of(folder_ / "out/cameras.json"))["images"],
             truth = json::parse(text_of(grid_flight() / "truth/cameras.json"))["images"];
  const Position first = position_of(found[0]["centre"]), true_first = position_of(truth[0]["centre"]);
  for (std::size_t i = 0; i < 6; ++i) {
    const Position at = position_of(found[i]["centre"]), true_at = position_of(truth[i]["centre"]);
    EXPECT_LT(in_plan(at, true_at), 15) << i;  // 300 m above ground whose slope is taken as 0 +- 1 degree
    for (const std::size_t k : {0U, 1U}) {
      EXPECT_LT(sd_of(found[i], k), 12) << i;
      EXPECT_LT(std::abs(at[k] - true_at[k]), 3 * sd_of(found[i], k)) << i;
    }
    EXPECT_NEAR(distance(at, first), distance(true_at, true_first), 0.01 * distance(true_at, true_first))
        << i;
  }
}

TEST_F(ReconstructInMapImage, OtherGroundLeavesTheFrameArbitrary) {
  for (std::size_t i = 0; i < 6; ++i) pictures_[i] = mirrored_picture(pictures_[i]);
  write_good(6);
  const Outcome other = run(orthophoto().string());
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_THAT(other.err, AllOf(HasSubstr("the frame is arbitrary"), HasSubstr("map image")));
  EXPECT_EQ(json::parse(text_of(folder_ / "out/cameras.json"))["frame"]["axes"], "arbitrary");
}

TEST_F(ReconstructInMapImage, AMapThatCannotServeIsRefusedAtOnce) {
  write_good(2);
  const Outcome missing = run("none.tif");
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("none.tif"));
  const Outcome plain = run(image(names_[0]).string());
  EXPECT_EQ(plain.code, 1);
  EXPECT_THAT(plain.err, AllOf(HasSubstr("the map image has no georeference"), HasSubstr("gdal_translate")));
  const Outcome both =
      run(orthophoto().string(), {"--cameras", (grid_flight() / "truth/cameras.json").string()});
  EXPECT_EQ(both.code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "out/cameras.json"));
}

/// Published pose of a frame of the Lander Vision System of Mars 2020 (position to some metres).
struct PublishedFrame {
  std::string name = {};
  Position body_fixed = {};
  double height = 0;  ///< above the place of touchdown, metres
};

constexpr double kMarsRadius = 3396190, kLat = 18.45 * std::numbers::pi / 180,
                 kLon = 77.45 * std::numbers::pi / 180;

// In the orthographic projection about (kLat, kLon).
Position projected(const PublishedFrame& frame) {
  const auto& [x, y, z] = frame.body_fixed;
  const double lat = std::atan2(z, std::hypot(x, y)), lon = std::atan2(y, x) - kLon;
  return {kMarsRadius * std::cos(lat) * std::sin(lon),
          kMarsRadius * (std::cos(kLat) * std::sin(lat) - std::sin(kLat) * std::cos(lat) * std::cos(lon)),
          frame.height};
}

// Twelve frames from 6 to 2 km above Jezero, whose motion along a line over level ground has a second
// solution, wrong by ten degrees, in a mosaic with pixels of 15.6 m. The map's projection stretches east
// against north by 5 % there.
TEST(RealDescent, PerseveranceIsPlacedInItsMap) {
  const fs::path data = fs::path(WAYMARK_SOURCE_DIR) / "../shared/data";
  if (!fs::exists(data / "descent/mars2020_lvs")) GTEST_SKIP() << "needs " << data / "descent/mars2020_lvs";
  TempFolder folder;
  fs::create_directories(folder / "frames");
  for (const char* time : {"51_35", "51_38", "51_45", "51_51", "51_56", "51_59", "52_02", "52_05", "52_08",
                           "52_12", "52_15", "52_18"}) {
    const std::string name = std::string("LVS_15_") + time + ".jpg";
    fs::copy_file(data / "descent/mars2020_lvs" / name, fs::path(folder / "frames") / name);
  }
  fs::copy_file(data / "descent/jezero_small.jpg", folder / "map.jpg");
  fs::copy_file(data / "reconstruction/mars2020_lvs/jezero_small.jgw", folder / "map.jgw");
  write_text(folder / "map.jpg.aux.xml",
             "<PAMDataset><SRS>+proj=eqc +R=3396190 +units=m +no_defs</SRS></PAMDataset>");
  write_text(
      folder / "lens.json",
      R"({"waymark_cameras": 1, "frame": {"axes": "arbitrary"}, "cameras": {"lvs": {"columns": 800, "rows": 800,
                 "fx": 469.1, "fy": 469.1, "cx": 401.0, "cy": 410.8, "lens": "fisheye", "distortion": [0.120304, 0.033668]}},
                 "images": [{"name": "LVS_15_51_35.jpg", "camera": "lvs"}]})");
  const Outcome made = waymark(
      {"reconstruct", folder / "frames", "--lens", folder / "lens.json", "--map", folder / "map.jpg", "--crs",
       "+proj=ortho +lat_0=18.45 +lon_0=77.45 +R=3396190", "--until", "poses", "-o", folder / "out"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("placed in the map image"));
  const PublishedFrame published[] = {
      {"LVS_15_51_38.jpg", {701403.2, 3145680.6, 1075894.4}, 5832},
      {"LVS_15_52_18.jpg", {700204.2, 3142714.1, 1074352.6}, 2350},
  };
  std::vector<Position> found, truth;
  const json cameras = json::parse(text_of(folder / "out/cameras.json"));
  for (const json& image : cameras["images"])
    for (const PublishedFrame& frame : published)
      if (image["name"] == frame.name) {
        found.push_back(position_of(image["centre"]));
        truth.push_back(projected(frame));
        EXPECT_LT(in_plan(found.back(), truth.back()), 0.05 * frame.height)
            << frame.name;  // no level terrain
        for (const std::size_t k : {0U, 1U})
          EXPECT_LT(std::abs(found.back()[k] - truth.back()[k]), 3 * sd_of(image, k)) << frame.name;
      }
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(distance(found[0], found[1]) / distance(truth[0], truth[1]), 1, 0.01);
}

}  // namespace
}  // namespace waymark::test
