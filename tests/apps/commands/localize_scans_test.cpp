// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/apps/localize_fixture.hpp"
#include "tests/apps/made_dem.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A table with a column `type` gives a map with tables of all types, most of them empty.
TEST_F(Localize, ScansAreSearchedForTheTypesThatTheMapHolds) {
  write_text(folder_.path() / "street.json",
             R"({"waymark_scenario":1,"name":"street","seed":4,"street":{"length":60}})");
  ASSERT_EQ(waymark({"simulate", folder_ / "street.json", "-o", folder_ / "drive"}).code, 0);
  std::istringstream truth(text_of(folder_ / "drive/truth/landmarks.csv"));
  std::string table, row;
  std::getline(truth, table);
  while (std::getline(truth, row))
    if (row.starts_with("pole,")) table += "\n" + row;
  write_text(folder_.path() / "survey.csv", table + "\n");
  const std::string map = folder_ / "survey.gpkg", log = folder_ / "drive/log.jsonl";
  ASSERT_EQ(waymark({"import", folder_ / "survey.csv", "-o", map, "--crs", "local"}).code, 0);
  for (const std::string method : {"ekf", "slam"}) {
    const auto track_by = [&](const std::string& scans) {
      const Outcome said = waymark({"localize", map, log, "-o", track_, "--method", method, "--ids",
                                    "unknown", "--start", "truth", "--set", "scans=" + scans});
      EXPECT_EQ(said.code, 0) << said.err;
      return text_of(track_);
    };
    EXPECT_TRUE(track_by("auto") == track_by("poles")) << method;
  }
}

// A thin post is a stem, too: in a map of both it is one sighting, which fits either.
TEST_F(Localize, ScansAreSearchedForAllTypesOfTheMap) {
  write_text(folder_.path() / "street.json",
             R"({"waymark_scenario":1,"name":"street","seed":5,"street":{"length":60,"tree_spacing":12}})");
  ASSERT_EQ(waymark({"simulate", folder_ / "street.json", "-o", folder_ / "drive"}).code, 0);
  std::istringstream truth(text_of(folder_ / "drive/truth/landmarks.csv"));
  std::string table, row;
  std::getline(truth, table);
  while (std::getline(truth, row))
    if (row.starts_with("pole,") || row.starts_with("tree,")) table += "\n" + row;
  write_text(folder_.path() / "survey.csv", table + "\n");
  const std::string map = folder_ / "survey.gpkg", log = folder_ / "drive/log.jsonl";
  ASSERT_EQ(waymark({"import", folder_ / "survey.csv", "-o", map, "--crs", "local"}).code, 0);
  struct Sums {
    int matched = 0, rejected = 0;
  };
  for (const std::string method : {"ekf", "pf"}) {  // SLAM matches landmarks of its own, too
    const auto sums_by = [&](const std::string& scans) {
      const Outcome said = waymark({"localize", map, log, "-o", track_, "--method", method, "--ids",
                                    "unknown", "--start", "truth", "--set", "scans=" + scans});
      EXPECT_EQ(said.code, 0) << said.err;
      Sums sums;
      std::istringstream track(text_of(track_));
      std::string line;
      std::getline(track, line);
      EXPECT_TRUE(line.starts_with("t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected"));
      while (std::getline(track, line)) {
        std::istringstream cells(line);
        std::string cell;
        for (int column = 0; std::getline(cells, cell, ','); ++column) {
          if (column == 11) sums.matched += std::stoi(cell);
          if (column == 12) sums.rejected += std::stoi(cell);
        }
      }
      return sums;
    };
    const Sums stems = sums_by("stems"), poles = sums_by("poles"), all = sums_by("auto");
    EXPECT_GT(all.matched, 1.2 * std::max(stems.matched, poles.matched)) << method;
    EXPECT_LT(all.rejected, 0.1 * all.matched) << method << ": each object is one sighting";
  }
}

// A circle about four beacons; the map has two of them; ranges are exact to a centimetre.
TEST_F(Localize, BeaconsThatADriveHasPlacedAreWrittenToAMap) {
  const std::map<std::string, std::pair<double, double>> beacons{
      {"north", {2, 24}}, {"east", {26, -3}}, {"south", {-4, -22}}, {"west", {-23, 5}}};
  const std::string map = folder_ / "two.gpkg";
  write_text(folder_ / "two.csv", "uid,x,y\nnorth,2,24\neast,26,-3\n");
  ASSERT_EQ(waymark({"import", folder_ / "two.csv", "-o", map, "--type", "beacon", "--map-crs", "local",
                     "--columns", "position_sd=0.02"})
                .code,
            0);
  std::string log = R"({"kind":"header","version":1,"frame":"map","range_sd":0.05})"
                    "\n";
  int i = 0;
  for (int k = 0; k < 600; ++k) {
    const double t = k / 5.0, a = t / 15, x = 15 * std::sin(a), y = -15 * std::cos(a);
    log += R"({"kind":"odometry","t":)" + std::to_string(t) +
           R"(,"v":1,"omega":0.0666667})"
           "\n";
    const auto& [uid, at] = *std::next(beacons.begin(), i++ % 4);
    log += R"({"kind":"sightings","t":)" + std::to_string(t) + R"(,"items":[{"range":)" +
           std::to_string(std::hypot(at.first - x, at.second - y)) + R"(,"landmark":")" + uid + "\"}]}\n";
  }
  write_text(folder_ / "log.jsonl", log);
  const auto run = [&](const std::string& from, const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "localize", from,    folder_ / "log.jsonl", "-o", track_, "--method", "beacons", "--start",
        "0,-15,0",  "--set", "start_sd=0.1"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  };
  const auto check = [&](const std::string& file) {
    EXPECT_EQ(waymark({"validate", file}).code, 0);
    const nlohmann::json found = nlohmann::json::parse(waymark({"query", file, "--format", "json"}).out);
    EXPECT_EQ(found.size(), 4u);
    for (const nlohmann::json& one : found) {
      const auto& [x, y] = beacons.at(one["uid"].get<std::string>());
      EXPECT_NEAR(one["x"], x, 0.3) << one["uid"];
      EXPECT_NEAR(one["y"], y, 0.3) << one["uid"];
      EXPECT_GT(one["confidence"].get<double>(), 0.9);
      EXPECT_LT(one["var_x"].get<double>(), 0.1);
    }
  };
  const std::string before = text_of(map);
  const Outcome said = run(map, {"--write-map", folder_ / "four.gpkg"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("2 landmarks changed, 2 added"));
  check(folder_ / "four.gpkg");
  EXPECT_EQ(text_of(map), before);
  ASSERT_EQ(run(map, {"--update-map"}).code, 0);
  check(map);
}

/// In a south polar map of the Moon the map frame's east is any direction of the grid.
TEST_F(Localize, WithCrsYawsAndCovariancesAreOfTheGridOfTheMap) {
  import_rocks("x,y,radius,height\n30000,-52000,0.5,0.6\n30020,-52000,0.5,0.6\n", "IAU_2015:30135");
  std::string log =
      R"({"kind":"header","version":1,"start":{"x":-30,"y":20,"yaw":0.3,"sd":0.01,"yaw_sd":0.0001},)"
      R"("odometry_noise":{"along_per_metre":0.1,"across_per_metre":1e-6,"yaw_per_metre":1e-9,)"
      R"("yaw_per_radian":1e-9}})"
      "\n";
  for (int i = 1; i <= 20; ++i)
    log += R"({"kind":"step","t":)" + std::to_string(i) + R"(,"dx":1,"dy":0,"dyaw":0})" + "\n";
  ASSERT_EQ(localize(log, {"--crs"}).code, 0);
  std::istringstream lines(text_of(track_));
  std::string line, cell;
  std::getline(lines, line);
  std::vector<std::array<double, 10>> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    for (double& value : rows.emplace_back()) std::getline(cells, cell, ','), value = std::stod(cell);
  }
  ASSERT_GE(rows.size(), 20);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto [x, y, yaw] = std::tuple{rows[i][1], rows[i][2], rows[i][6]};
    const double driven = std::atan2(y - rows[i - 1][2], x - rows[i - 1][1]);
    EXPECT_NEAR(std::remainder(yaw - driven, 2 * std::numbers::pi), 0, 1e-3) << "row " << i;
    // The error lies along the drive.
    const auto [xx, yy, xy] = std::tuple{rows[i][7], rows[i][8], rows[i][9]};
    EXPECT_NEAR(std::remainder(std::atan2(2 * xy, xx - yy) / 2 - driven, std::numbers::pi), 0, 0.05);
  }
}

}  // namespace
}  // namespace waymark::test
