// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/exchanged_sides.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/random.hpp"
#include "workflows/localization/mirrored_log.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using localization::Pose2;
using testing::HasSubstr;

/// Range from a pose to the walls of a room of 8 by 5 m with a niche, so that it is no image of itself.
double range_in_room(const Pose2& pose, double bearing) {
  const double c = std::cos(pose.yaw + bearing), s = std::sin(pose.yaw + bearing);
  for (double range = 0.05;; range += 0.02) {
    const double x = pose.x + range * c, y = pose.y + range * s;
    const bool niche = x > 1 && x < 2 && y > 0 && y < 3.5;
    if (!niche && (x < -4 || x > 4 || y < -2.5 || y > 2.5)) return range;
  }
}

/// A drive of 60 scans, or sets of sightings of six poles, at a constant turn rate.
localization::RobotLog drive(double turn_rate, bool with_scans) {
  constexpr double kPoles[][2] = {{3, 2}, {-1, 2.3}, {0.4, -2}, {-3, -1}, {3.5, -1.2}, {-2.8, 1.4}};
  Random random(3);
  localization::RobotLog log;
  Pose2 pose{-1, -1, 0.2};
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * i;
    log.events.push_back({t, localization::StepReading{{0.05, 0, turn_rate * 0.5}}});
    pose = pose * Pose2{0.05, 0, turn_rate * 0.5};
    log.truth.push_back({t, pose});
    if (with_scans) {
      localization::LaserScan scan;
      scan.robot_from_sensor = {0.1, 0, turn_rate / 8};
      scan.first_angle = -2, scan.angle_step = 0.04;
      for (int k = 0; k < 100; ++k)
        scan.ranges.push_back(static_cast<float>(
            range_in_room(pose * scan.robot_from_sensor, scan.first_angle + k * scan.angle_step) +
            0.01 * random.normal()));
      log.events.push_back({t, scan});
    } else {
      localization::SightingSet set;
      for (const auto& [x, y] : kPoles) {
        localization::SeenLandmark seen;
        seen.range = std::hypot(x - pose.x, y - pose.y) + 0.03 * random.normal();
        seen.bearing = std::atan2(y - pose.y, x - pose.x) - pose.yaw + 0.01 * random.normal();
        set.sightings.push_back(seen);
      }
      log.events.push_back({t, set});
    }
  }
  return log;
}

std::string by_odometry(const localization::RobotLog& log) {
  return exchanged_sides_warning(log, poses_by_odometry(log), "the odometry");
}

TEST(ExchangedSides, OfScansAreNamed) {
  const localization::RobotLog log = drive(0.4, true);
  EXPECT_EQ(by_odometry(log), "");
  EXPECT_EQ(exchanged_sides_warning(log, log.truth, "the poses"), "");
  for (const MirroredPart part : {MirroredPart::sensors, MirroredPart::motion})
    EXPECT_THAT(by_odometry(mirror_log(log, part)),
                HasSubstr("the scans fit the odometry if left and right"));
  const localization::RobotLog sensors = mirror_log(log, MirroredPart::sensors);
  EXPECT_THAT(exchanged_sides_warning(sensors, log.truth, "the poses"), HasSubstr("the scans fit the poses"));
}

TEST(ExchangedSides, OfSightingsAreNamed) {
  const localization::RobotLog log = drive(0.4, false);
  EXPECT_EQ(by_odometry(log), "");
  EXPECT_THAT(by_odometry(mirror_log(log, MirroredPart::sensors)),
              HasSubstr("the sightings fit the odometry"));
}

// Scans and motion that are both exchanged fit each other: only a map says so.
TEST(ExchangedSides, OfTheWholeRobotFitTheOdometry) {
  EXPECT_EQ(by_odometry(mirror_log(drive(0.4, true), MirroredPart::robot)), "");
}

TEST(ExchangedSides, OfADriveWithoutTurnsAreNotKnown) {
  const localization::RobotLog log = drive(0, true);
  EXPECT_EQ(by_odometry(log), "");
  EXPECT_EQ(by_odometry(mirror_log(log, MirroredPart::sensors)), "");
}

TEST(ExchangedSides, CountLooksThatDifferAndPointsThatReturn) {
  localization::RobotLog log = drive(0.4, true);
  const SeenCells seen = count_seen_cells(log, log.truth);
  EXPECT_EQ(seen.looks, 60);
  EXPECT_EQ(seen.points, 6000);
  EXPECT_LT(seen.as_written, seen.exchanged);
  for (localization::LogEvent& event : log.events)
    if (auto* scan = std::get_if<localization::LaserScan>(&event.what))
      for (std::size_t i = 0; i < scan->ranges.size(); i += 2) scan->ranges[i] = std::nanf("");
  EXPECT_EQ(count_seen_cells(log, log.truth).points, 3000);
  for (localization::StampedPose& pose : log.truth) pose.pose = {};  // the robot stands
  EXPECT_EQ(count_seen_cells(log, log.truth).looks, 1);
  EXPECT_EQ(count_seen_cells(log, {}).looks, 0);
}

}  // namespace
}  // namespace waymark::test
