// SPDX-License-Identifier: Apache-2.0
// What a session refuses or drops, and what it shows.
#include "ros/waymark_ros/src/robot_session.hpp"

#include <gmock/gmock.h>

#include "tests/ros/waymark_ros/src/robot_session_fixture.hpp"

namespace waymark::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST_F(Session, MessagesThatCannotBeUsedAreCountedByReason) {
  RobotSession live = session();
  Odometry odometry = made_.odometry[0];
  odometry.body = "base_footprint";
  EXPECT_TRUE(live.take(odometry).empty());
  odometry = made_.odometry[0], odometry.pose.at.x() = std::nan("");
  EXPECT_TRUE(live.take(odometry).empty());
  Scan scan = made_.scans[0];
  scan.frame = "camera";
  EXPECT_TRUE(live.take(scan).empty());
  scan = made_.scans[0], scan.angle_increment = 0;
  EXPECT_TRUE(live.take(scan).empty());
  StaticTransform over = placed("tilted", 0, 1);
  over.parent_from_child.turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY());
  live.take(over);
  scan = made_.scans[0], scan.frame = "tilted";
  EXPECT_TRUE(live.take(scan).empty());
  EXPECT_TRUE(live.take(Fix{.frame = "base_link", .status = -1}).empty());
  EXPECT_TRUE(live.take(Fix{.frame = "base_link", .latitude = 91}).empty());
  EXPECT_TRUE(live.take(Fix{.frame = "base_link", .covariance_type = 7}).empty());
  static_cast<void>(live.take(Fix{.frame = "base_link", .latitude = 48, .longitude = 11}));
  EXPECT_TRUE(live.flush().empty());  // the map has a local CRS
  const auto values = live.status().values;
  for (const char* reason :
       {"odometry is of base_footprint in odom, not of base_link in odom", "the pose of odometry is no pose",
        "no static transform leads from camera to base_link",
        "a scan has no beams, or its angles or ranges are not finite",
        "the scanner tilted is tilted by more than 11 degrees", "the receiver has no satellite fix",
        "a satellite fix is no latitude and longitude", "there is no type of covariance 7",
        "a satellite fix has no position in the CRS of the map"})
    EXPECT_THAT(values, Contains(Pair(std::string("dropped: ") + reason, "1")));
}

TEST_F(Session, MarkersShowTheMapAndWhatIsSeen) {
  RobotSession live = session();
  EXPECT_EQ(live.map_markers().size(), made_.trees.size());
  EXPECT_EQ(live.map_markers()[0].name, "tree");
  const PoseReports reports = play(live, made_);
  std::size_t matched = 0;
  for (const Marker& marker : live.sighting_markers()) {
    if (marker.name != "matched") continue;
    ++matched;
    const auto is_there = [&](const Tree& t) {
      return std::hypot(t.x - marker.at.x(), t.y - marker.at.y()) < 1e-5;
    };
    EXPECT_TRUE(std::ranges::any_of(made_.trees, is_there));
  }
  EXPECT_GT(matched, 3u);
}

TEST_F(Session, SettingsThatWillNotDoAreRefusedAtOnce) {
  const auto refusal = [&](const auto& change) {
    SessionSettings how = settings();
    change(how);
    try {
      RobotSession made(how);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal([](auto& s) { s.start = "1,2"; }), HasSubstr("the parameter start"));
  EXPECT_THAT(refusal([](auto& s) { s.start = "1,2,90"; }), HasSubstr("radians"));
  EXPECT_THAT(refusal([](auto& s) { s.request.method = "graph"; }), HasSubstr("needs the whole log"));
  EXPECT_THAT(refusal([](auto& s) { s.request.map = "absent.gpkg"; }), HasSubstr("absent.gpkg"));
  EXPECT_THAT(refusal([](auto& s) { s.request.set = {"start_ds=1"}; }), HasSubstr("start_sd"));
  EXPECT_THAT(refusal([](auto& s) { s.max_delay = 2; }), HasSubstr("max_delay"));
  EXPECT_THAT(refusal([](auto& s) { s.request.method = "odometry", s.start = "none"; }),
              HasSubstr("must know where the robot starts"));
}

}  // namespace
}  // namespace waymark::test
