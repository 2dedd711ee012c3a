// SPDX-License-Identifier: Apache-2.0
// Messages out of order, clocks that are set back, and initial poses.
#include <gmock/gmock.h>

#include "tests/ros/waymark_ros/src/robot_session_fixture.hpp"

namespace waymark::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST_F(Session, MessagesThatOvertakeOthersAreTakenInOrderAndLateOnesAreCounted) {
  RobotSession ordered = session(), mixed = session();
  const PoseReports expected = play(ordered, made_);
  PoseReports reports;
  const auto add = [&](PoseReports more) { std::ranges::move(more, std::back_inserter(reports)); };
  SessionSettings how = settings();
  how.max_delay = 0.6;
  mixed = session(how);
  for (std::size_t i = 0; i + 1 < made_.odometry.size(); i += 2) {  // each second message comes first
    add(mixed.take(made_.odometry[i + 1]));
    add(mixed.take(made_.scans[i + 1]));
    add(mixed.take(made_.scans[i]));
    add(mixed.take(made_.odometry[i]));
  }
  add(mixed.take(made_.odometry.back())), add(mixed.take(made_.scans.back()));
  add(mixed.flush());
  ASSERT_EQ(reports.size(), expected.size());
  EXPECT_EQ(reports.back().at.pose, expected.back().at.pose);

  how.max_delay = 0;
  RobotSession hasty = session(how);
  static_cast<void>(hasty.take(made_.odometry[0]));
  static_cast<void>(hasty.take(made_.odometry[2]));
  EXPECT_TRUE(hasty.take(made_.scans[1]).empty());
  EXPECT_EQ(hasty.take(made_.scans[2]).size(), 1u);
  EXPECT_THAT(
      hasty.status().values,
      Contains(Pair("dropped: stamps of scan laser are too late behind those of other sensors", "1")));
}

TEST_F(Session, AClockThatIsSetBackBeginsAgainAtTheStart) {
  RobotSession live = session();
  const PoseReports first = play(live, made_), second = play(live, made_);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].at.pose, second[i].at.pose);
    EXPECT_EQ(first[i].map_from_odom.has_value(), second[i].map_from_odom.has_value());
  }
  EXPECT_THAT(live.status().values, Contains(Pair("restarts by clock", "1")));
  EXPECT_THAT(live.take_warnings(), Contains(HasSubstr("jump back")));
  EXPECT_TRUE(live.take_warnings().empty());
}

TEST_F(Session, WaitsForAnInitialPoseAndKeepsItForTheNextReplay) {
  SessionSettings how = settings();
  how.start.clear();
  RobotSession live = session(how);
  EXPECT_EQ(live.status().message, "waiting for an initial pose");
  EXPECT_TRUE(play(live, made_).empty());
  InitialPose pose{.frame = "odom", .pose = {.at = {0, -10, 0}}};
  live.take(pose);
  EXPECT_THAT(live.status().values,
              Contains(Pair("dropped: an initial pose is in the frame 'odom', not in map", "1")));
  EXPECT_EQ(live.status().message, "waiting for an initial pose");
  pose.frame = "map";
  pose.covariance[0] = pose.covariance[7] = 0.25, pose.covariance[35] = 0.04;
  live.take(pose);
  const PoseReports reports = play(live, made_);  // its stamps jump back
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(live.status().message, "tracking");
  EXPECT_LT((reports.back().at.pose.at() - made_.truth.back().at()).norm(), 0.1);
  static_cast<void>(live.take(made_.odometry[0]));  // and back again, now without scans
  static_cast<void>(live.take(made_.odometry[1]));
  const PoseReports first = live.flush();
  ASSERT_EQ(first.size(), 1u);
  EXPECT_NEAR(first[0].covariance[0], 0.25, 0.05);
  EXPECT_THAT(live.status().values, Contains(Pair("restarts by clock", "2")));
}

TEST_F(Session, AnInitialPoseMovesARobotWhileItDrives) {
  RobotSession live = session();
  for (std::size_t i = 0; i < 40; ++i)
    static_cast<void>(live.take(made_.odometry[i])), static_cast<void>(live.take(made_.scans[i]));
  live.take(InitialPose{.frame = "map", .pose = {.at = {100, 50, 0}}});
  static_cast<void>(live.flush());
  EXPECT_TRUE(live.take(made_.odometry[40]).empty());  // it waits
  const PoseReports last = live.flush();
  ASSERT_EQ(last.size(), 1u);
  EXPECT_LT((last[0].at.pose.at() - Eigen::Vector2d(100, 50)).norm(), 1);
  // The transform follows, although odometry has gone on.
  ASSERT_TRUE(last[0].map_from_odom);
  const Eigen::Vector3d there =
      last[0].map_from_odom->at + last[0].map_from_odom->turn * made_.odometry[40].pose.at;
  EXPECT_LT((there.head<2>() - last[0].at.pose.at()).norm(), 1e-9);
}

TEST_F(Session, GapsInTheOdometryAreCounted) {
  RobotSession live = session();
  for (const std::size_t i : {0u, 1u, 9u, 10u}) static_cast<void>(live.take(made_.odometry[i]));
  static_cast<void>(live.flush());
  EXPECT_THAT(live.status().values, Contains(Pair("gaps in the odometry", "1")));
  EXPECT_THAT(live.status().values, Contains(Pair("longest gap, s", "2.000000")));
}

}  // namespace
}  // namespace waymark::test
