// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/mirrored_log.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/atomic_file.hpp"
#include "core/locked_folder.hpp"
#include "core/random.hpp"
#include "workflows/localization/localize.hpp"
#include "workflows/mapping/import_landmarks.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A drive along an arc through 12 poles, with left and right as the format states or exchanged.
class MirroredLog : public testing::Test {
 protected:
  MirroredLog() {
    std::string table = "uid,x,y,diameter,position_sd\n";
    for (const auto& [x, y] : kPoles)
      table += std::to_string(int(x)) + "," + std::to_string(x) + "," + std::to_string(y) + ",0.2,0.02\n";
    write_file(file("poles.csv"), table);
    ImportRequest import{.table = file("poles.csv"), .map = file("map.gpkg")};
    import.options.type = "pole";
    import.options.table_crs = "local";
    import_landmarks(import);
  }

  /// Warnings of a drive; `bearing` and `turn` are 1, or -1 if they are exchanged. Each set has sightings of
  /// `unmapped` further poles, which move.
  std::string warnings(double bearing, double turn, int unmapped = 0) {
    Random random(5);
    std::string log = R"({"kind":"header","version":1,"start":{"x":0,"y":0,"yaw":0,"sd":0.1,"yaw_sd":0.02}})";
    for (int k = 0; k < 80; ++k) {
      const double t = 0.5 * k, yaw = turn_rate_ * t, x = std::sin(yaw) / turn_rate_,
                   y = (1 - std::cos(yaw)) / turn_rate_;
      log += "\n" + json{{"kind", "odometry"}, {"t", t}, {"v", 1}, {"omega", turn * turn_rate_}}.dump();
      json items = json::array();
      for (const auto& [px, py] : kPoles) {
        const double range = std::hypot(px - x, py - y);
        if (range > 12) continue;
        const double angle = std::remainder(std::atan2(py - y, px - x) - yaw, 2 * 3.14159265358979);
        items.push_back({{"type", "pole"},
                         {"range", range + 0.03 * random.normal()},
                         {"range_sd", 0.03},
                         {"bearing", bearing * angle},
                         {"bearing_sd", 0.01}});
      }
      for (int i = 0; i < unmapped; ++i)
        items.push_back({{"type", "pole"},
                         {"range", random.uniform(2, 12)},
                         {"range_sd", 0.03},
                         {"bearing", random.uniform(-3, 3)},
                         {"bearing_sd", 0.01}});
      log += "\n" + json{{"kind", "sightings"}, {"t", t}, {"items", items}}.dump();
    }
    write_file(file("log.jsonl"), log + "\n");
    std::string said;
    localize({.map = file("map.gpkg"), .log = file("log.jsonl")}, {.message = [&](const Message& message) {
               if (message.kind == MessageKind::warning) said += message.text + "\n";
             }});
    return said;
  }

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  double turn_rate_ = 0.02;  // rad/s
  static constexpr std::pair<double, double> kPoles[] = {{4, 3},   {7, -5}, {11, 6},  {14, -2},
                                                         {17, 8},  {21, 1}, {24, 11}, {27, 3},
                                                         {29, 15}, {33, 7}, {35, 18}, {38, 12}};
  LockedFolder folder_{std::filesystem::temp_directory_path()};
};

TEST_F(MirroredLog, IsNamedAndAGoodOneIsNot) {
  EXPECT_EQ(warnings(1, 1), "");
  EXPECT_THAT(warnings(-1, 1), HasSubstr("exchanged in its bearings and beams: 451 of 451"));
  EXPECT_THAT(warnings(-1, -1), HasSubstr("exchanged in its bearings and beams and its motion: 451 of 451"));
}

TEST_F(MirroredLog, IsNamedAmongObjectsThatTheMapLacks) {
  EXPECT_EQ(warnings(1, 1, 6), "");
  EXPECT_THAT(warnings(-1, 1, 6), HasSubstr("exchanged in its bearings and beams"));
  EXPECT_THAT(warnings(-1, -1, 6),
              testing::AllOf(HasSubstr("exchanged in its bearings and beams"), HasSubstr("its motion")));
}

// At 0.02 rad/s the filter corrects turns to the other side; at 0.3 rad/s it cannot.
TEST_F(MirroredLog, TurnsToTheOtherSideAreNamed) {
  turn_rate_ = 0.3;
  EXPECT_EQ(warnings(1, 1), "");
  EXPECT_THAT(warnings(1, -1), HasSubstr("exchanged in its motion"));
  EXPECT_THAT(warnings(-1, -1), HasSubstr("exchanged in its bearings and beams and its motion"));
}

TEST(MirrorLog, TwiceIsTheSame) {
  localization::RobotLog log;
  localization::LaserScan scan{
      .robot_from_sensor = {1, 0.5, 0.2}, .first_angle = -1, .angle_step = 0.5, .ranges = {1, 2, 3}};
  log.events = {{0, localization::TwistReading{1, 0.2, 0.3}}, {1, scan}};
  const localization::RobotLog other = mirror_log(log, MirroredPart::robot);
  const auto& seen = std::get<localization::LaserScan>(other.events[1].what);
  // The beams at -1, -0.5 and 0 rad become those at 1, 0.5 and 0.
  EXPECT_EQ(seen.first_angle, 0);
  EXPECT_THAT(seen.ranges, testing::ElementsAre(3, 2, 1));
  EXPECT_EQ(seen.robot_from_sensor.y, -0.5);
  EXPECT_EQ(std::get<localization::TwistReading>(other.events[0].what).turn, -0.3);
  const localization::RobotLog same = mirror_log(other, MirroredPart::robot);
  EXPECT_EQ(std::get<localization::LaserScan>(same.events[1].what).first_angle, -1);
  const localization::RobotLog sensors = mirror_log(log, MirroredPart::sensors);
  EXPECT_EQ(std::get<localization::TwistReading>(sensors.events[0].what).turn, 0.3);
  EXPECT_EQ(std::get<localization::LaserScan>(sensors.events[1].what).robot_from_sensor.y, 0.5);
  const localization::RobotLog motion = mirror_log(log, MirroredPart::motion);
  EXPECT_EQ(std::get<localization::TwistReading>(motion.events[0].what).turn, -0.3);
  EXPECT_EQ(std::get<localization::LaserScan>(motion.events[1].what).first_angle, -1);
}

}  // namespace
}  // namespace waymark::test
