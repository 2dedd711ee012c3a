// SPDX-License-Identifier: Apache-2.0
// `waymark locate` on images of a made Moon.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/random.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kPi = 3.14159265358979, kDegree = kPi / 180, kMoon = 1737400;
constexpr double kFocal = 1500, kSide = 1024;

struct SphereCrater {
  double lon, lat, radius;  // degrees, m
};

/// Position of a camera that looks straight down, degrees and m.
struct View {
  double lon, lat, altitude, azimuth;
};

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The craters in an image by the formulas of a sphere, without those of the library.
std::string detections(const std::vector<SphereCrater>& craters, const View& view, Random& random) {
  const double lon = view.lon * kDegree, lat = view.lat * kDegree;
  const std::array<double, 3> up{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)},
      east{-std::sin(lon), std::cos(lon), 0},
      north{-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat)};
  std::string text = "x,y,diameter,confidence\n";
  for (const SphereCrater& c : craters) {
    const double a = c.lon * kDegree, b = c.lat * kDegree;
    const std::array<double, 3> at{std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b)};
    if (dot(at, up) < kMoon / (kMoon + view.altitude)) continue;  // behind the horizon
    const double depth = kMoon + view.altitude - kMoon * dot(at, up), e = kMoon * dot(at, east),
                 n = kMoon * dot(at, north);
    const double right = e * std::cos(view.azimuth) - n * std::sin(view.azimuth),
                 ahead = e * std::sin(view.azimuth) + n * std::cos(view.azimuth);
    const double radius = c.radius * kFocal / depth, sd = std::hypot(1, 0.05 * radius);
    const double x = kFocal * right / depth + kSide / 2 - 0.5 + sd * random.normal(),
                 y = -kFocal * ahead / depth + kSide / 2 - 0.5 + sd * random.normal();
    if (!(x >= 0 && y >= 0 && x < kSide && y < kSide) || radius < 5 || random.bernoulli(0.3)) continue;
    text += std::to_string(x) + "," + std::to_string(y) + "," +
            std::to_string(2 * radius * std::exp(0.1 * random.normal())) + ",0.9\n";
    if (random.bernoulli(0.3))
      text += std::to_string(random.uniform(0, kSide)) + "," + std::to_string(random.uniform(0, kSide)) +
              "," + std::to_string(2 * radius) + ",0.6\n";
  }
  return text;
}

class Locate : public testing::Test {
 protected:
  void SetUp() override {
    Random random(31, "a made Moon");
    std::string table = "type,uid,x,y,radius\n";
    for (int i = 0; i < 20000; ++i) {
      const SphereCrater c{random.uniform(-180, 180), std::asin(random.uniform(-1, 1)) / kDegree,
                           4500 / std::sqrt(random.uniform(1e-3, 1))};
      craters_.push_back(c);
      if (random.bernoulli(0.15)) continue;
      table += "crater,c" + std::to_string(i) + "," + std::to_string(c.lon) + "," + std::to_string(c.lat) +
               "," + std::to_string(c.radius) + "\n";
    }
    write_text(folder_ / "craters.csv", table);
    const Outcome made =
        waymark({"import", folder_ / "craters.csv", "-o", map_, "--map-crs", "IAU_2015:30100"});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  std::vector<std::string> words(const std::vector<std::string>& more) {
    std::vector<std::string> all{"locate", map_};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "moon.gpkg";
  std::vector<SphereCrater> craters_;
};

TEST_F(Locate, FindsImagesAnywhere) {
  Random random(77, "images");
  std::vector<View> views;
  std::vector<std::string> files;
  for (int i = 0; i < 12; ++i) {
    views.push_back({random.uniform(-180, 180), std::asin(random.uniform(-1, 1)) / kDegree,
                     random.log_uniform(450e3, 1200e3), random.uniform(-kPi, kPi)});
    files.push_back(folder_ / ("image" + std::to_string(i) + ".csv"));
    write_text(files.back(), detections(craters_, views.back(), random));
  }
  files.insert(files.end(), {"--size", "1024", "1024", "--focal", "1500", "-o", folder_ / "positions.csv",
                             "--matches", folder_ / "matches.csv", "--format", "json"});
  const Outcome said = waymark(words(files));
  ASSERT_EQ(said.code, 0) << said.err;
  const json result = json::parse(said.out);
  EXPECT_GT(result["craters"], 16000);
  int right = 0;
  double nees = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const json& image = result["images"][i];
    if (!image["located"]) continue;
    const double north = (double(image["lat_deg"]) - views[i].lat) * kDegree * kMoon,
                 east = std::remainder(double(image["lon_deg"]) - views[i].lon, 360) * kDegree * kMoon *
                        std::cos(views[i].lat * kDegree);
    const double pixel = views[i].altitude / kFocal;
    EXPECT_LT(std::hypot(north, east), 20 * pixel) << i;
    EXPECT_NEAR(double(image["altitude_m"]), views[i].altitude, 0.02 * views[i].altitude) << i;
    EXPECT_NEAR(std::remainder(double(image["azimuth_deg"]) * kDegree - views[i].azimuth, 2 * kPi), 0, 0.02)
        << i;
    EXPECT_LT(double(image["wrong_probability"]), 1e-3);
    const auto& c = image["covariance"];
    const double a = c[0][0], b = c[0][1], d = c[1][1];
    nees += (d * east * east - 2 * b * east * north + a * north * north) / (a * d - b * b) / 2;
    ++right;
  }
  EXPECT_GE(right, 11);
  EXPECT_LT(nees / right, 3);  // 24 degrees of freedom, and errors of the covariances
  EXPECT_GT(nees / right, 0.2);
  EXPECT_THAT(text_of(folder_ / "positions.csv"), HasSubstr("wrong_probability"));
  EXPECT_THAT(text_of(folder_ / "matches.csv"), HasSubstr(",c"));
}

// Craters that `waymark craters` finds in a DEM of the Moon, located among those that people mapped.
TEST(LocateRealCraters, InACatalogueOfTheWholeMoon) {
  const std::filesystem::path data = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/craters";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not on this machine";
  const TempFolder folder;
  const std::string large = folder / "large.gpkg", small = folder / "small.gpkg", moon = folder / "moon.gpkg";
  for (const auto& [file, map, columns] :
       {std::array<std::string, 3>{"HeadCraters.csv", large, "x=Lon,y=Lat,radius=Diam_km*500"},
        {"LROCCraters.csv", small, "x=Long,y=Lat,radius=\"Diameter (km)\"*500"}}) {
    const Outcome made = waymark({"import", data / "catalogues" / file, "-o", map, "--type", "crater",
                                  "--map-crs", "IAU_2015:30100", "--columns", columns});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  ASSERT_EQ(waymark({"merge", large, small, "-o", moon}).code, 0);
  ASSERT_EQ(
      waymark({"craters", "--dem", data / "gld100/highland_e160_200.tif", "-o", folder / "found.gpkg"}).code,
      0);
  const Outcome found = waymark({"query", folder / "found.gpkg", "--format", "json"});
  ASSERT_EQ(found.code, 0) << found.err;
  std::vector<SphereCrater> craters;  // the DEM is an equidistant cylindrical one about 180 E
  for (const json& c : json::parse(found.out))
    craters.push_back(
        {180 + double(c["x"]) / kMoon / kDegree, double(c["y"]) / kMoon / kDegree, c["radius"]});
  ASSERT_GT(craters.size(), 1000U);

  constexpr double kWidth = 300e3;  // m
  Random random(51, "windows");
  std::vector<View> views;
  std::vector<std::string> words{"locate", moon};
  for (int i = 0; i < 10; ++i) {  // the last four mirrored
    const View view{random.uniform(168, 192), random.uniform(-10, 10), 0, random.uniform(-kPi, kPi)};
    const double scale = random.uniform(150, 600), lat = view.lat * kDegree;
    std::string text = "x,y,diameter\n";
    for (const SphereCrater& c : craters) {  // an orthographic image
      const double a = (c.lon - view.lon) * kDegree, b = c.lat * kDegree;
      const double e = kMoon * std::cos(b) * std::sin(a),
                   n = kMoon * (std::cos(lat) * std::sin(b) - std::sin(lat) * std::cos(b) * std::cos(a));
      const double right = e * std::cos(view.azimuth) - n * std::sin(view.azimuth),
                   ahead = e * std::sin(view.azimuth) + n * std::cos(view.azimuth);
      if (std::max(std::abs(right), std::abs(ahead)) > kWidth / 2) continue;
      text += std::to_string((kWidth / 2 + (i < 6 ? right : -right)) / scale) + "," +
              std::to_string((kWidth / 2 - ahead) / scale) + "," + std::to_string(2 * c.radius / scale) +
              "\n";
    }
    views.push_back(view);
    words.push_back(folder / ("window" + std::to_string(i) + ".csv"));
    write_text(words.back(), text);
  }
  words.insert(words.end(), {"-o", folder / "positions.csv", "--format", "json"});
  const Outcome said = waymark(words);
  ASSERT_EQ(said.code, 0) << said.err;
  const json images = json::parse(said.out)["images"];
  int right = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!images[i]["located"]) continue;
    ASSERT_LT(i, 6U) << "a mirrored window";
    const double north = (double(images[i]["lat_deg"]) - views[i].lat) * kDegree * kMoon,
                 east = std::remainder(double(images[i]["lon_deg"]) - views[i].lon, 360) * kDegree * kMoon *
                        std::cos(views[i].lat * kDegree);
    // The middle of the box of the detections is up to some kilometres from that of the window.
    EXPECT_LT(std::hypot(north, east), 12e3) << i;
    EXPECT_LT(double(images[i]["wrong_probability"]), 1e-9) << i;
    ++right;
  }
  EXPECT_GE(right, 5);
}

TEST_F(Locate, RefusesWhatIsNotInTheMap) {
  Random random(3, "scattered");
  std::string scattered = "x,y,radius\n";
  for (int i = 0; i < 40; ++i)
    scattered += std::to_string(random.uniform(0, kSide)) + "," + std::to_string(random.uniform(0, kSide)) +
                 "," + std::to_string(5 / std::sqrt(random.uniform(0.01, 1))) + "\n";
  write_text(folder_ / "scattered.csv", scattered);
  const Outcome said = waymark(
      words({folder_ / "scattered.csv", "--size", "1024", "1024", "--focal", "1500", "--altitude", "600e3"}));
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("not located: "));
}

TEST_F(Locate, SaysWhatIsMissing) {
  write_text(folder_ / "no_size.csv", "x,y\n1,2\n");
  EXPECT_THAT(waymark(words({folder_ / "no_size.csv"})).err,
              HasSubstr("columns x, y and diameter or radius"));
  write_text(folder_ / "bad.csv", "x,y,radius\n1,2,three\n");
  EXPECT_THAT(waymark(words({folder_ / "bad.csv"})).err,
              AllOf(HasSubstr("needs numbers"), HasSubstr("line 2")));
  write_text(folder_ / "good.csv", "x,y,radius\n1,2,3\n");
  EXPECT_THAT(waymark(words({folder_ / "good.csv"})).err, HasSubstr("too few craters in the image"));
  EXPECT_THAT(waymark(words({folder_ / "good.csv", "--altitude", "100"})).err,
              HasSubstr("an altitude gives no scale without the focal length"));
  EXPECT_THAT(waymark(words({folder_ / "good.csv", "--altitude", "-1"})).err, HasSubstr("not above 0 m"));
  EXPECT_THAT(
      waymark(words({folder_ / "good.csv", "--altitude", "9", "--focal", "9", "--scale", "1", "2"})).err,
      HasSubstr("exclude each other"));
  EXPECT_THAT(waymark(words({folder_ / "good.csv", "--scale", "2", "1"})).err,
              HasSubstr("the smaller first"));
  EXPECT_THAT(waymark(words({folder_ / "good.csv", "--size", "0", "1"})).err, HasSubstr("not positive"));
  EXPECT_THAT(waymark(words({folder_ / "good.csv", "--focal", "-1"})).err,
              HasSubstr("focal length is negative"));
  const Outcome replaced = waymark({"locate", map_, folder_ / "good.csv", "-o", map_});
  EXPECT_EQ(replaced.code, 2);
  EXPECT_THAT(replaced.err, HasSubstr("the output would replace"));
  EXPECT_THAT(waymark({"locate", "--settings"}).out, HasSubstr("max_wrong"));
  write_text(folder_ / "plain.csv", "type,x,y,radius\ncrater,1,2,3\n");
  ASSERT_EQ(
      waymark({"import", folder_ / "plain.csv", "-o", folder_ / "plain.gpkg", "--map-crs", "local"}).code, 0);
  EXPECT_THAT(waymark({"locate", folder_ / "plain.gpkg", folder_ / "good.csv"}).err, HasSubstr("on no body"));
}

}  // namespace
}  // namespace waymark::test
