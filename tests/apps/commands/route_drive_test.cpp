// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A made site of 90 m, and a route across it on its diagonal.
class RouteDriveCommand : public testing::Test {
 protected:
  RouteDriveCommand() {
    write_scenario({{"route", "wander"}, {"length", 5}});
    const Outcome made = waymark({"-q", "simulate", folder_ / "s.json", "-o", folder_ / "site"});
    EXPECT_EQ(made.code, 0) << made.err;
    make_map("map.gpkg", 0);
    write_text(folder_ / "route.csv", "x,y\n-28,-28\n0,0\n28,28\n");
  }

  void write_scenario(const json& drive) {
    json scenario{{"waymark_scenario", 1},
                  {"seed", 3},
                  {"ground", {{"width", 90}, {"height", 90}, {"cell", 0.5}}},
                  {"relief", {{"rms", 0.3}, {"max_wavelength", 100}, {"roughness", 0.3}}},
                  {"craters", {{"density", 0}}},
                  {"rocks", {{"k", 0.08}, {"min_diameter", 0.8}, {"max_diameter", 2}}},
                  {"dunes", {{"cover", 0}}},
                  {"flights", json::array()},
                  {"drive",
                   {{"truth_in_log", false},
                    {"laser", {{"step", 0.5}, {"rays", 3}}},
                    {"odometry", {{"yaw_bias_sd", 0.02}}}}}};
    scenario["drive"].update(drive);
    write_text(folder_ / "s.json", scenario.dump());
  }

  /// Imports the true rocks, without those within `free` metres of the diagonal.
  void make_map(const std::string& name, double free) {
    std::istringstream rows(text_of(folder_ / "site/truth/landmarks.csv"));
    std::string row, cell, rocks = "x,y,radius,height\n";
    std::getline(rows, row);
    std::vector<std::string> names;
    for (std::istringstream cells(row); std::getline(cells, cell, ',');) names.push_back(cell);
    while (std::getline(rows, row)) {
      std::map<std::string, std::string> value;
      std::istringstream cells(row);
      for (std::size_t i = 0; i < names.size() && std::getline(cells, cell, ','); ++i) value[names[i]] = cell;
      if (std::abs(std::stod(value["x"]) - std::stod(value["y"])) / std::sqrt(2) < free) continue;
      rocks += value["x"] + "," + value["y"] + "," + value["radius"] + "," + value["height"] + "\n";
    }
    write_text(folder_ / "rocks.csv", rocks);
    const Outcome made = waymark(
        {"import", folder_ / "rocks.csv", "-o", folder_ / name, "--type", "rock", "--map-crs", "local"});
    EXPECT_EQ(made.code, 0) << made.err;
  }

  Outcome simulate(const json& navigation, const std::string& threads = "2") {
    write_scenario({{"route", "route.csv"}, {"navigation", navigation}});
    return waymark(
        {"--threads", threads, "simulate", folder_ / "s.json", "-o", folder_ / "drive", "--drive-only"});
  }
  json report() { return json::parse(text_of(folder_ / "drive/drive.json")); }

  TempFolder folder_;
};

TEST_F(RouteDriveCommand, TheTrackOfTheDriveIsThatOfItsLog) {
  for (const std::string method : {"ekf", "pf"}) {
    const Outcome driven = simulate({{"map", "map.gpkg"}, {"method", method}});
    ASSERT_EQ(driven.code, 0) << driven.err;
    EXPECT_THAT(driven.err, HasSubstr("drive along a route of 79 m: reached the goal"));
    EXPECT_TRUE(report()["reached"]);
    EXPECT_TRUE(report()["contact"].is_null());
    EXPECT_LT(report()["goal_distance"], 3);
    EXPECT_LT(report()["worst_error"], 1.5);
    EXPECT_GT(report()["driven"], 74);
    const Outcome localized =
        waymark({"localize", folder_ / "map.gpkg", folder_ / "drive/log.jsonl", "-o", folder_ / "t.csv",
                 "--ids", "unknown", "--method", method, "--sensor", "horizontal_laser", "--seed", "3"});
    ASSERT_EQ(localized.code, 0) << localized.err;
    EXPECT_EQ(text_of(folder_ / "t.csv"), text_of(folder_ / "drive/track.csv")) << method;
  }
}

TEST_F(RouteDriveCommand, ThreadsDoNotChangeADrive) {
  std::vector<std::string> texts;
  for (const std::string threads : {"1", "2"}) {
    ASSERT_EQ(simulate({{"map", "map.gpkg"}, {"method", "pf"}}, threads).code, 0);
    texts.push_back(text_of(folder_ / "drive/log.jsonl") + text_of(folder_ / "drive/drive.json") +
                    text_of(folder_ / "drive/truth/track.csv"));
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST_F(RouteDriveCommand, RocksThatTheMapLacksAreAvoided) {
  make_map("bare.gpkg", 4);
  ASSERT_EQ(simulate({{"map", "bare.gpkg"}, {"avoid", false}}).code, 0);
  EXPECT_EQ(report()["ended"], "contact");
  EXPECT_THAT(report()["contact"].get<std::string>(), HasSubstr("a rock of"));
  const Outcome avoided = simulate({{"map", "bare.gpkg"}});
  ASSERT_EQ(avoided.code, 0) << avoided.err;
  EXPECT_EQ(report()["ended"], "goal") << avoided.err;
  EXPECT_GE(report()["replans"], 1);
  EXPECT_EQ(report()["events"][0]["kind"].get<std::string>() == "replanned" ||
                report()["events"][0]["kind"].get<std::string>() == "stopped",
            true);
  // A vehicle that may not plan again stands before the obstacle.
  ASSERT_EQ(simulate({{"map", "bare.gpkg"}, {"replans", 0}}).code, 0);
  EXPECT_EQ(report()["ended"], "hazard");
  EXPECT_TRUE(report()["contact"].is_null());
}

TEST_F(RouteDriveCommand, BadRoutesAreRefused) {
  EXPECT_THAT(simulate({{"method", "ekf"}}).err, HasSubstr("drive.navigation.map is missing"));
  EXPECT_THAT(simulate({{"map", "none.gpkg"}}).err, HasSubstr("none.gpkg"));
  EXPECT_THAT(simulate({{"map", "map.gpkg"}, {"dem", "none.tif"}}).err, HasSubstr("none.tif"));
  const auto with = [&](const std::string& route) {
    write_text(folder_ / "route.csv", route);
    const Outcome refused = simulate({{"map", "map.gpkg"}});
    EXPECT_EQ(refused.code, 1);
    return refused.err;
  };
  EXPECT_THAT(with("a,b\n1,2\n"), HasSubstr("the route has no columns x and y"));
  EXPECT_THAT(with("x,y\n1,2\n"), HasSubstr("the route has 1 stations, two are needed"));
  EXPECT_THAT(with("x,y\n1,2\n,3\n"), HasSubstr("a station of the route has no position"));
  EXPECT_THAT(with("x,y\n0,0\n90000,0\n"), HasSubstr("the route jumps 90 km"));
  EXPECT_THAT(with("x,y\n500,0\n510,0\n"), HasSubstr("the route begins at 500.0, 0.0, outside the site"));
  write_scenario({{"route", "round"}});
  EXPECT_THAT(waymark({"simulate", folder_ / "s.json", "-o", folder_ / "x", "--drive-only"}).err,
              HasSubstr("drive.route must not be 'round'"));
}

TEST_F(RouteDriveCommand, RoutesOfEveryFormatAreTheSame) {
  const auto plan = [&](const std::string& file) {
    const Outcome planned =
        waymark({"route", folder_ / "map.gpkg", "--from=-28,-28", "--to", "-10,-20", "--sensor",
                 "horizontal_laser", "--weight", "1", "-o", folder_ / file, "--worlds", "1"});
    ASSERT_EQ(planned.code, 0) << planned.err;
  };
  std::vector<std::string> logs;
  for (const std::string file : {"r.csv", "r.gpkg", "r.geojson"}) {
    plan(file);
    write_scenario({{"route", file}, {"navigation", {{"map", "map.gpkg"}}}});
    const Outcome driven = waymark({"simulate", folder_ / "s.json", "-o", folder_ / "drive", "--drive-only"});
    ASSERT_EQ(driven.code, 0) << driven.err;
    logs.push_back(text_of(folder_ / "drive/drive.json"));
  }
  EXPECT_EQ(logs[0], logs[1]);
  EXPECT_EQ(logs[0], logs[2]);
  EXPECT_GT(json::parse(logs[0])["planned_worst_sd"], 0.05);
}

TEST_F(RouteDriveCommand, ARigidBodyFollowsARouteByItsEstimate) {
  write_scenario(
      {{"route", "route.csv"}, {"dynamics", {{"on", true}}}, {"navigation", {{"map", "map.gpkg"}}}});
  const Outcome driven = waymark({"simulate", folder_ / "s.json", "-o", folder_ / "drive", "--drive-only"});
  ASSERT_EQ(driven.code, 0) << driven.err;
  EXPECT_TRUE(report()["reached"]) << driven.err;
  EXPECT_LT(report()["rms_error"], 0.5);
  // Wheels slip: the rims turn farther than the body moves.
  double rims = 0, before = 0, speed = 0;
  std::istringstream lines(text_of(folder_ / "drive/log.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const json row = json::parse(line);
    if (row["kind"] != "odometry") continue;
    rims += speed * (row["t"].get<double>() - before);
    before = row["t"], speed = row["v"];
  }
  EXPECT_GT(rims, 1.04 * report()["driven"].get<double>());
}

TEST_F(RouteDriveCommand, DynamicsNeedAVehicleWithAMass) {
  write_text(folder_ / "light.json", R"({"waymark_vehicle": 1, "supports": [{"x": 1, "y": 1, "diameter": 0.5},
    {"x": 1, "y": -1, "diameter": 0.5}, {"x": -1, "y": 1, "diameter": 0.5}, {"x": -1, "y": -1, "diameter": 0.5}]})");
  const auto refusal = [&](const json& dynamics) {
    write_scenario({{"route", "wander"}, {"length", 5}, {"dynamics", dynamics}});
    const Outcome failed = waymark({"simulate", folder_ / "s.json", "-o", folder_ / "drive", "--drive-only"});
    EXPECT_EQ(failed.code, 2) << failed.err;
    return failed.err;
  };
  EXPECT_THAT(refusal({{"on", true}, {"vehicle", "light.json"}}), HasSubstr("has no mass"));
  EXPECT_THAT(refusal({{"on", true}, {"vehicle", "hovercraft"}}), HasSubstr("hovercraft"));
  EXPECT_THAT(refusal({{"on", true}, {"friction", 80}}),
              HasSubstr("drive.dynamics.friction = 80 is outside"));
  write_text(folder_ / "s.json", R"({"waymark_scenario": 1, "flights": [], "hall": {},
    "drive": {"dynamics": {"on": true}}})");
  const Outcome hall = waymark({"simulate", folder_ / "s.json", "-o", folder_ / "hall"});
  EXPECT_EQ(hall.code, 2);
  EXPECT_THAT(hall.err, HasSubstr("the ground of a street or a hall is level"));
}

}  // namespace
}  // namespace waymark::test
