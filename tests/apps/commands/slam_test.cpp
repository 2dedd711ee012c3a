// SPDX-License-Identifier: Apache-2.0
// SLAM and graphs through the program: maps written, taken back, and never half there.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <sstream>
#include <thread>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A drive round a ring of rocks, `rounds` times, as a log; `hidden`: a rock that is gone.
std::string drive(double rounds, int hidden = -1) {
  std::mt19937 bits(7);  // the standard fixes its numbers, unlike those of distributions
  const auto noise = [&](double sd) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += double(bits()) / double(std::mt19937::max());
    return sd * sum;
  };
  std::string text = R"({"kind":"header","version":1,"start":{"x":10,"y":0,"yaw":1.5707963}})"
                     "\n";
  const int steps = int(rounds * 63);
  for (int i = 0; i <= steps; ++i) {
    const double t = i, a = 0.1 * t, x = 10 * std::cos(a), y = 10 * std::sin(a),
                 yaw = a + std::numbers::pi / 2;
    text +=
        nlohmann::json{{"kind", "odometry"}, {"t", t}, {"v", 1 + noise(0.02)}, {"omega", 0.1 + noise(0.002)}}
            .dump() +
        "\n";
    nlohmann::json items = nlohmann::json::array();
    for (int k = 0; k < 12; ++k) {
      if (k == hidden) continue;
      const double r = k % 2 ? 14 : 7, b = 2 * std::numbers::pi * k / 12 + 0.2;
      const double dx = r * std::cos(b) - x, dy = r * std::sin(b) - y;
      const double bearing = std::remainder(std::atan2(dy, dx) - yaw, 2 * std::numbers::pi);
      if (std::hypot(dx, dy) > 9 || std::abs(bearing) > 1.5) continue;
      items.push_back({{"type", "rock"},
                       {"range", std::hypot(dx, dy) + noise(0.05)},
                       {"bearing", bearing + noise(0.01)},
                       {"range_sd", 0.05},
                       {"bearing_sd", 0.01},
                       {"features", {{"radius", 0.3 + 0.05 * k}}}});
    }
    text += nlohmann::json{{"kind", "sightings"}, {"t", t + 0.001}, {"items", items}}.dump() + "\n";
    text += nlohmann::json{{"kind", "truth"},
                           {"t", t},
                           {"x", x},
                           {"y", y},
                           {"yaw", std::remainder(yaw, 2 * std::numbers::pi)}}
                .dump() +
            "\n";
  }
  return text;
}

class SlamCommand : public ::testing::Test {
 protected:
  void SetUp() override { write_text(folder_ / "drive.jsonl", drive(2)); }
  Outcome localize(const std::string& map, const std::vector<std::string>& more,
                   const std::string& method = "slam") {
    std::vector<std::string> words{"localize", map,   folder_ / "drive.jsonl", "-o", folder_ / "track.csv",
                                   "--method", method};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  nlohmann::json rocks(const std::string& map) {
    return nlohmann::json::parse(waymark({"query", map, "--format", "json"}).out);
  }
  std::string sound(const std::string& map) {
    const Outcome checked = waymark({"validate", map});
    return checked.code == 0 ? "" : checked.out + checked.err;
  }
  TempFolder folder_;
};

TEST_F(SlamCommand, MakesAMapFromNothingAndFollowsTheRobot) {
  const std::string map = folder_ / "made.gpkg";
  const Outcome made = localize("none", {"--write-map", map});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(sound(map), "");
  EXPECT_THAT(waymark({"query", map, "--format", "csv"}).out, HasSubstr("rock"));
  const Outcome score = waymark(
      {"evaluate", "track", folder_ / "track.csv", "--truth", folder_ / "drive.jsonl", "--format", "json"});
  EXPECT_LT(nlohmann::json::parse(score.out).at("ate_rmse").get<double>(), 0.4) << score.out;
}

TEST_F(SlamCommand, FromNothingUsesFixesOnlyWithAStart) {
  std::istringstream lines(drive(1));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    text += line + "\n";
    nlohmann::json fix = nlohmann::json::parse(line);
    if (fix["kind"] != "truth") continue;
    fix["kind"] = "gnss", fix["sd"] = 0.3;
    text += fix.dump() + "\n";
  }
  write_text(folder_ / "drive.jsonl", text);
  const Outcome unknown = localize("none", {"--start", "none"});
  ASSERT_EQ(unknown.code, 0) << unknown.err;
  EXPECT_THAT(unknown.err, HasSubstr("64 GNSS and compass readings are not used"));
  const Outcome known = localize("none", {"--start", "10,0,1.5708"});
  EXPECT_THAT(known.err, HasSubstr("GNSS and compass readings: 64, 0 of them not used"));
  const Outcome graph = localize("none", {"--start", "none"}, "graph");
  ASSERT_EQ(graph.code, 0) << graph.err;
  EXPECT_THAT(graph.err, Not(HasSubstr("give --start")));
}

TEST_F(SlamCommand, TheRunRecordsEverySetting) {
  for (const std::string method : {"slam", "graph"}) {
    const std::string map = folder_ / (method + ".gpkg");
    const Outcome made =
        localize("none", {"--write-map", map, "--set", "slam_margin=7", "--settings"}, method);
    ASSERT_EQ(made.code, 0) << made.err;
    const auto job = nlohmann::json::parse(bash("sqlite3 " + map + " 'SELECT job FROM run'").out);
    EXPECT_EQ(job["method"], method);
    EXPECT_EQ(job["settings"]["slam_margin"], 7);
    std::size_t listed = 0;
    std::istringstream lines(made.out);
    for (std::string line; std::getline(lines, line);) {
      const std::string name = line.substr(0, line.find('='));
      if (name.find(' ') == std::string::npos && line.find('=') != std::string::npos) {
        EXPECT_TRUE(job["settings"].contains(name)) << name;
        ++listed;
      }
    }
    EXPECT_EQ(listed, job["settings"].size());
    EXPECT_GE(listed, 60u);
  }
}

TEST_F(SlamCommand, AnUpdateIsOneRunAndCanBeTakenBack) {
  const std::string map = folder_ / "made.gpkg";
  ASSERT_EQ(localize("none", {"--write-map", map}).code, 0);
  const std::string before = text_of(map);
  const Outcome updated = localize(map, {"--update-map"});
  ASSERT_EQ(updated.code, 0) << updated.err;
  EXPECT_EQ(sound(map), "");
  EXPECT_NE(text_of(map), before);
  EXPECT_EQ(text_of(map + ".before-run-2"), before);
  const Outcome restored = waymark({"restore", map});
  EXPECT_EQ(restored.code, 0) << restored.err;
  EXPECT_EQ(text_of(map), before);
  const Outcome again = waymark({"restore", map});
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("there is no backup of this map"));
}

TEST_F(SlamCommand, WriteMapLeavesTheMapAlone) {
  const std::string map = folder_ / "made.gpkg", next = folder_ / "next.gpkg";
  ASSERT_EQ(localize("none", {"--write-map", map}).code, 0);
  const std::string before = text_of(map);
  ASSERT_EQ(localize(map, {"--write-map", next}).code, 0);
  EXPECT_EQ(text_of(map), before);
  EXPECT_EQ(sound(next), "");
}

TEST_F(SlamCommand, ARockThatIsGoneLosesConfidence) {
  const std::string map = folder_ / "made.gpkg";
  ASSERT_EQ(localize("none", {"--write-map", map}).code, 0);
  write_text(folder_ / "drive.jsonl", drive(6, 3));
  const Outcome updated = localize(map, {"--update-map"});
  ASSERT_EQ(updated.code, 0) << updated.err;
  EXPECT_THAT(updated.err, HasSubstr("1 of the map not there"));
  EXPECT_EQ(sound(map), "");
}

// The same drives, but the DEM has a wall round the rock: it could not have been seen.
TEST_F(SlamCommand, ARockTheGroundHidesIsNotMissed) {
  const std::string map = folder_ / "made.gpkg";
  ASSERT_EQ(localize("none", {"--write-map", map}).code, 0);
  write_text(folder_ / "drive.jsonl", drive(6, 3));
  MadeDem dem;
  dem.columns = dem.rows = 161;
  dem.crs = "";
  dem.geotransform = {-20.125, 0.25, 0, 20.125, 0, -0.25};
  const double b = 2 * std::numbers::pi * 3 / 12 + 0.2;
  dem.height = [&](int column, int row) {
    const double away =
        std::hypot(-20 + 0.25 * column - 14 * std::cos(b), 20 - 0.25 * row - 14 * std::sin(b));
    return away > 1.5 && away < 2.7 ? 5.0 : 0.0;
  };
  for (const std::string method : {"slam", "graph"}) {
    const Outcome seen = localize(
        map, {"--dem", make_dem(folder_ / "dem.tif", dem), "--write-map", folder_ / (method + ".gpkg")},
        method);
    ASSERT_EQ(seen.code, 0) << seen.err;
    if (method == "slam") {
      EXPECT_THAT(seen.err, HasSubstr(" 0 of the map not there"));
    }
  }
}

TEST_F(SlamCommand, TheGraphOfADriveIsNoWorseThanTheFilter) {
  const auto rmse = [&](const std::string& method) {
    const Outcome said = localize("none", {}, method);
    EXPECT_EQ(said.code, 0) << said.err;
    if (method == "graph") {
      EXPECT_THAT(said.out, HasSubstr("converged            true"));
    }
    const Outcome score = waymark(
        {"evaluate", "track", folder_ / "track.csv", "--truth", folder_ / "drive.jsonl", "--format", "json"});
    const auto found = nlohmann::json::parse(score.out);
    EXPECT_GT(found.at("poses").get<int>(), 100);
    return found.at("ate_rmse").get<double>();
  };
  const double filter = rmse("slam"), graph = rmse("graph");
  EXPECT_LT(graph, 0.25);
  EXPECT_LT(graph, 1.1 * filter);
}

TEST_F(SlamCommand, KilledAtAnyMomentTheMapIsTheOldOrTheNewOne) {
  const std::string map = folder_ / "made.gpkg", first = folder_ / "first.gpkg";
  ASSERT_EQ(localize("none", {"--write-map", first}).code, 0);
  const std::string before = text_of(first);
  int changed = 0;
  for (int step = 0; step < 24; ++step) {
    write_text(map, before);
    const pid_t child = start_waymark({"localize", map, folder_ / "drive.jsonl", "-o", folder_ / "track.csv",
                                       "--method", "slam", "--update-map"});
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + 15 * step));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const bool same = text_of(map) == before;
    changed += !same;
    if (same) continue;
    ASSERT_EQ(sound(map), "") << step;
    ASSERT_EQ(text_of(map + ".before-run-2"), before) << step;
  }
  SUCCEED() << changed << " of 24 had been carried out";
}

TEST_F(SlamCommand, WrongWishesAreRefused) {
  const Outcome both = localize("none", {"--update-map"});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("there is no map to update"));
  const Outcome ekf = waymark({"localize", "none", folder_ / "drive.jsonl", "-o", folder_ / "t.csv",
                               "--method", "odometry", "--write-map", folder_ / "m.gpkg"});
  EXPECT_EQ(ekf.code, 2);
  EXPECT_THAT(ekf.err, HasSubstr("does not change maps"));
  const Outcome name = localize("none", {"--write-map", folder_ / "m.csv"});
  EXPECT_EQ(name.code, 2);
  const Outcome graph = waymark({"localize", "none", folder_ / "missing.g2o", "-o", folder_ / "t.csv",
                                 "--method", "graph", "--log-format", "g2o"});
  EXPECT_EQ(graph.code, 1);
}

// Half an hour in a car, 7230 scans of its laser, no map; the truth is GPS, good to a few decimetres.
TEST(RealSlam, VictoriaParkFromTheRawLaser) {
  const auto park = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/localization/victoria_park";
  if (!std::filesystem::exists(park)) GTEST_SKIP() << park << " is not on this machine";
  TempFolder folder;
  const std::string track = folder / "track.csv";
  const Outcome made = waymark({"localize", "none", park, "--log-format", "victoria-park", "--method", "slam",
                                "--timing", "-o", track});
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome said = waymark(
      {"evaluate", "track", track, "--truth", park, "--align", "se2", "--max-gap", "5", "--format", "json"});
  ASSERT_EQ(said.code, 0) << said.err;
  const auto score = nlohmann::json::parse(said.out);
  std::cout << "ATE " << score["ate_rmse"] << " m, " << score["time_per_update_us"] << " us per scan\n";
  EXPECT_GT(score["poses"], 8000);
  EXPECT_LT(score["ate_rmse"], 1.37);
}

}  // namespace
}  // namespace waymark::test
