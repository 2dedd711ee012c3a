// SPDX-License-Identifier: Apache-2.0
// `waymark register` on a map whose true place is known.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kScale = 1.25, kYaw = 0.5, kEast = 612'000, kNorth = 5'230'000;

/// A catalogue of craters in UTM, and a map of its south-western part in a frame of its own.
class Register : public testing::Test {
 protected:
  void SetUp() override {
    Random random(7, "register");
    std::string catalogue = "x,y,diameter\n", part = "type,uid,x,y,z,radius\n";
    for (int i = 0; i < 150; ++i) {
      const double x = random.uniform(0, 20'000), y = random.uniform(0, 20'000);
      const double diameter = 250 / std::sqrt(1 - 0.99 * random.uniform());
      catalogue += row({kEast + x, kNorth + y, diameter * std::exp(random.normal(0, 0.04))});
      if (x > 8'000 || y > 8'000) continue;
      const double error = 0.02 * diameter;
      const double east = x + random.normal(0, error), north = y + random.normal(0, error);
      part += "crater,c" + std::to_string(i) + "," + row(back(east, north, 100, diameter / 2 / kScale));
      truth_["c" + std::to_string(i)] = {kEast + x, kNorth + y, diameter};
    }
    part += "rock,stone," + row(back(4'000, 4'000, 110, 2 / kScale));
    write_text(folder_ / "catalogue.csv", catalogue);
    write_text(folder_ / "part.csv", part);
    const Outcome made = waymark({"import", folder_ / "part.csv", "-o", rough_, "--map-crs", "local"});
    ASSERT_EQ(made.code, 0) << made.err;
  }

  static std::string row(const std::vector<double>& values) {
    std::string out;
    for (const double v : values) out += (out.empty() ? "" : ",") + std::to_string(v);
    return out + "\n";
  }
  static std::vector<double> back(double x, double y, double z, double radius) {
    return {(std::cos(kYaw) * x + std::sin(kYaw) * y) / kScale,
            (-std::sin(kYaw) * x + std::cos(kYaw) * y) / kScale, z, radius};
  }
  Outcome registered(std::vector<std::string> more = {}) {
    std::vector<std::string> words{"register", rough_,       "--to", folder_ / "catalogue.csv",
                                   "--crs",    "EPSG:32632", "-o",   map_};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }

  TempFolder folder_;
  std::string rough_ = folder_ / "rough.gpkg", map_ = folder_ / "map.gpkg";
  std::map<std::string, std::vector<double>> truth_;
};

TEST_F(Register, MovesAllLandmarksAndKeepsTheRuns) {
  const Outcome said = registered();
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("wrong with a probability of"));
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
  int craters = 0;
  for (const json& one : json::parse(waymark({"query", map_, "--format", "json"}).out)) {
    if (one["uid"] == "stone") {
      EXPECT_NEAR(one["x"], kEast + 4'000, 40);
      EXPECT_NEAR(one["y"], kNorth + 4'000, 40);
      EXPECT_NEAR(one["radius"], 2, 0.03);
      continue;
    }
    const auto& truth = truth_.at(one["uid"]);
    EXPECT_NEAR(one["x"], truth[0], 40 + 0.08 * truth[2]);
    EXPECT_NEAR(one["y"], truth[1], 40 + 0.08 * truth[2]);
    EXPECT_NEAR(2 * double(one["radius"]), truth[2], 0.02 * truth[2]);
    ++craters;
  }
  EXPECT_EQ(craters, int(truth_.size()));
  EXPECT_EQ(bash("sqlite3 " + map_ + " 'SELECT count(*) FROM run'").out, "2\n");
}

TEST_F(Register, RefusesACatalogueOfOtherTerrain) {
  std::string other = "x,y,diameter\n";
  Random random(8, "elsewhere");
  for (int i = 0; i < 150; ++i)
    other += row({kEast + random.uniform(0, 20'000), kNorth + random.uniform(0, 20'000),
                  250 / std::sqrt(1 - 0.99 * random.uniform())});
  write_text(folder_ / "catalogue.csv", other);
  const Outcome said = registered();
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("the map is not registered: "));
  EXPECT_THAT(said.err, HasSubstr("with a probability of"));
}

TEST_F(Register, RefusesBadOptionsAndTooFewCraters) {
  EXPECT_THAT(registered({"--max-scale", "0.5"}).err, HasSubstr("--max-scale 0.5 is not a factor above 1"));
  EXPECT_THAT(registered({"--max-wrong", "2"}).err, HasSubstr("--max-wrong 2 is not a probability"));
  EXPECT_THAT(registered({"--within", "-1"}).err, HasSubstr("--within -1 is not a distance above 0"));
  write_text(folder_ / "catalogue.csv", "x,y,diameter\n612000,5230000,300\n");
  const Outcome said = registered();
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("and 1 of the catalogue are too few: 4 of each are needed"));
}

/// Relief of 3 km, and a map of 800 m of it in a frame of its own, with a DEM.
class RegisterByHeights : public testing::Test {
 protected:
  void SetUp() override {
    Random random(11, "register by heights");
    for (int i = 0; i < 120; ++i) {
      const double x = random.uniform(0, 3000), y = random.uniform(0, 3000), width = random.uniform(40, 200);
      hills_.push_back({x, y, width, random.uniform(-0.25, 0.25) * width});
    }
    make_dem(orbital_, {.columns = 300,
                        .rows = 300,
                        .height = [&](int c, int r) { return height(10 * c + 5, 2995 - 10 * r); },
                        .geotransform = {kEast, 10, 0, kNorth + 3000, 0, -10}});
    make_dem(dem_, {.columns = 200,
                    .rows = 200,
                    .height =
                        [&](int c, int r) {
                          const auto [x, y] = forth(4 * c - 398, 398 - 4 * r);
                          return (height(x, y) + 50) / kScale;
                        },
                    .crs = "",
                    .geotransform = {-400, 4, 0, 400, 0, -4}});
    std::string rocks = "type,uid,x,y,z,radius,position_sd\n";
    for (int i = 0; i < 20; ++i) {
      const double x = random.uniform(-350, 350), y = random.uniform(-350, 350);
      const auto [east, north] = forth(x, y);
      const std::string uid = "r" + std::to_string(i);
      rocks += "rock," + uid + "," + std::to_string(x) + "," + std::to_string(y) + "," +
               std::to_string((height(east, north) + 50) / kScale) + ",2,0.1\n";
      truth_[uid] = {kEast + east, kNorth + north, height(east, north)};
    }
    write_text(folder_ / "rocks.csv", rocks);
    const Outcome made = waymark({"import", folder_ / "rocks.csv", "-o", rough_, "--map-crs", "local"});
    ASSERT_EQ(made.code, 0) << made.err;
  }

  double height(double x, double y) const {
    double sum = 0;
    for (const auto& h : hills_)
      sum += h[3] * std::exp(-(std::pow(x - h[0], 2) + std::pow(y - h[1], 2)) / (2 * h[2] * h[2]));
    return sum;
  }
  static std::pair<double, double> forth(double x, double y) {
    return {1400 + kScale * (std::cos(kYaw) * x - std::sin(kYaw) * y),
            1600 + kScale * (std::sin(kYaw) * x + std::cos(kYaw) * y)};
  }

  TempFolder folder_;
  std::vector<std::array<double, 4>> hills_;
  std::string rough_ = folder_ / "rough.gpkg", map_ = folder_ / "map.gpkg", dem_ = folder_ / "own.tif",
              orbital_ = folder_ / "orbital.tif";
  std::map<std::string, std::vector<double>> truth_;
};

TEST_F(RegisterByHeights, MovesLandmarksInPlanAndHeight) {
  const Outcome said = waymark({"register", rough_, "--dem", dem_, "--to", orbital_, "-o", map_});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("cells differ by"));
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
  EXPECT_EQ(bash("sqlite3 " + map_ + " 'SELECT count(*) FROM run'").out, "2\n");
  const json all = json::parse(waymark({"query", map_, "--format", "json"}).out);
  ASSERT_EQ(all.size(), truth_.size());
  for (const json& one : all) {
    const auto& truth = truth_.at(one["uid"]);
    EXPECT_NEAR(one["x"], truth[0], 2);  // a fifth of a cell
    EXPECT_NEAR(one["y"], truth[1], 2);
    EXPECT_NEAR(one["z"], truth[2], 0.3);
    EXPECT_NEAR(one["radius"], 2 * kScale, 0.02);
  }
  const auto scale = [&](const char* column) {
    return std::stod(bash("sqlite3 " + map_ + " 'SELECT min(" + column + ") FROM rock'").out);
  };
  EXPECT_GT(scale("var_x"), std::pow(0.1 * kScale, 2));  // with the covariance of the registration
}

TEST_F(RegisterByHeights, WithinLeavesOutOtherPlaces) {
  const Outcome near = waymark({"register", rough_, "--dem", dem_, "--to", orbital_, "-o", map_, "--crs",
                                "EPSG:32632", "--within", "1000"});
  EXPECT_EQ(near.code, 1);  // the map's middle is (0, 0), 5,000 km away
  EXPECT_THAT(near.err, HasSubstr("the map is not registered"));
}

TEST_F(RegisterByHeights, AMapWithoutHeightsNeedsADem) {
  const Outcome said = waymark({"register", rough_, "--to", orbital_, "-o", map_});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("name the DEM of the map by --dem"));
}

TEST_F(RegisterByHeights, FlatTerrainIsRefused) {
  make_dem(orbital_, {.columns = 300,
                      .rows = 300,
                      .height = [](int c, int r) { return (c * 7 + r * 13) % 5 * 0.01; },
                      .geotransform = {kEast, 10, 0, kNorth + 3000, 0, -10}});
  const Outcome said = waymark({"register", rough_, "--dem", dem_, "--to", orbital_, "-o", map_});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("the map is not registered: "));
}

}  // namespace
}  // namespace waymark::test
