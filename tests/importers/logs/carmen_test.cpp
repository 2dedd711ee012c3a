// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::HasSubstr;

class CarmenLog : public ::testing::Test {
 protected:
  RobotLog read(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
    return importers::import_log(file_, {});
  }
  std::string refusal(const std::string& text) {
    return message_of([&] { read(text); });
  }
  void TearDown() override { std::filesystem::remove(file_); }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("waymark_carmen_" + std::to_string(getpid()) + ".clf");
};

const char* const kSound =
    "# comment\n"
    "PARAM robot_frontlaser_offset 0.3 1 nohost 0\n"
    "ODOM 1 2 0 0 0 0 10.0 nohost 0\n"
    "FLASER 4 1 2 81.9 0 1 2 0 1 3 1.5707963 10.5 nohost 0.5\n"
    "SYNC x\n";

TEST_F(CarmenLog, HoldsStepsAndScans) {
  const RobotLog log = read(kSound);
  ASSERT_EQ(log.events.size(), 2u);
  const auto& step = std::get<StepReading>(log.events[0].what).step;
  EXPECT_NEAR(step.x, 0, 1e-9);
  EXPECT_NEAR(step.y, 1, 1e-9);
  EXPECT_NEAR(step.yaw, 1.5707963, 1e-9);
  const auto& scan = std::get<LaserScan>(log.events[1].what);
  EXPECT_EQ(log.events[1].t, 10.5);
  EXPECT_EQ(scan.ranges.size(), 4u);
  EXPECT_NEAR(scan.first_angle, -std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(scan.angle_step, std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(scan.robot_from_sensor.x, 0.3);
  EXPECT_THAT(log.remarks, testing::Contains(HasSubstr("1 lines of other messages are skipped")));
}

// The odometry of such robots drifts; nothing in the log says by how much.
TEST_F(CarmenLog, OdometryHasErrorsThatPersist) {
  const RobotLog log = read(kSound);
  EXPECT_GT(log.drift.curvature_sd, 0);
  EXPECT_GT(log.drift.scale_sd, 0);
}

TEST_F(CarmenLog, NewerScansHoldTheirOwnGeometry) {
  const RobotLog log = read(
      "ROBOTLASER1 0 -0.5 1.0 0.25 50 0.01 0 3 5 6 7 1 9 1.2 2 0.1 1 2 0 0 0 0.3 0.3 1e6 12.5 nohost 0\n");
  ASSERT_EQ(log.events.size(), 1u);
  const auto& scan = std::get<LaserScan>(log.events[0].what);
  EXPECT_EQ(scan.first_angle, -0.5);
  EXPECT_EQ(scan.angle_step, 0.25);
  EXPECT_EQ(scan.max_range, 50);
  EXPECT_NEAR(scan.robot_from_sensor.x, 0.2, 1e-9);
  EXPECT_NEAR(scan.robot_from_sensor.yaw, 0.1, 1e-9);
  EXPECT_EQ(log.events[0].t, 12.5);
}

TEST_F(CarmenLog, BadLinesAreSkippedAndCounted) {
  const RobotLog log = read(std::string(kSound) +
                            "FLASER 4 1 2\nFLASER x\nODOM 1 2 nan 0 0 0 11 nohost 0\n"
                            "FLASER 1e18 1\nFLASER -1 1\n"
                            "FLASER 2 0 0 1 3 1.57 1 3 1.57 12 nohost 0\n");
  EXPECT_THAT(log.remarks, testing::Contains(HasSubstr("5 lines are cut off or hold no numbers")));
  EXPECT_THAT(log.remarks, testing::Contains(HasSubstr("the first is line 6")));
  EXPECT_THAT(log.remarks, testing::Contains(HasSubstr("scans have from 2 to 4 beams")));
  EXPECT_THAT(log.remarks, testing::Contains(HasSubstr("1 of 2 scans have no return")));
}

TEST_F(CarmenLog, AnglesInDegreesAreRefused) {
  EXPECT_THAT(refusal("ODOM 1 2 90 0 0 0 10.0 nohost 0\n"), HasSubstr("an angle is 90"));
}

TEST_F(CarmenLog, WithoutAnythingToReadIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("neither odometry nor scans"));
  EXPECT_THAT(refusal("FLASER 3 1\n"), HasSubstr("the first bad one is line 1"));
  EXPECT_THAT(refusal("BZh91AY"), HasSubstr("the log is packed"));
}

}  // namespace
}  // namespace waymark::test
