// SPDX-License-Identifier: Apache-2.0
// The track of a session is that of the command for the recording, and its reports follow the rules of ROS.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "importers/logs/gyro_yaw.hpp"
#include "tests/ros/waymark_ros/src/robot_session_fixture.hpp"

namespace waymark::test {
namespace {

using ::testing::Contains;
using ::testing::Pair;

TEST_F(Session, GivesTheTrackThatLocalizeGivesForTheRecording) {
  for (const char* method : {"ekf", "ukf", "pf", "odometry"}) {
    SessionSettings how = settings();
    how.request.method = method;
    how.request.set = {"start_sd=0.3"};
    RobotSession live = session(how);
    const PoseReports reports = play(live, made_);
    workflows::LocalizeRequest request = how.request;
    request.log = bag(made_), request.start = how.start;
    const localization::Track track = workflows::localize(request).track;
    expect_same(reports, track);
    const double off = (reports.back().at.pose.at() - made_.truth.back().at()).norm();
    if (std::string(method) == "odometry")
      EXPECT_GT(off, 0.3);
    else
      EXPECT_LT(off, 0.1) << method;  // the wheels alone are off by 0.4 m
    EXPECT_EQ(reports.back().status, localization::LocalizationStatus::tracking);
  }
}

TEST_F(Session, GivesTheYawOfTheGyroAsTheReaderOfRecordings) {
  MadeRecording made = made_;
  for (Odometry& o : made.odometry) o.pose.turn.setIdentity();  // wheels that count distance alone
  SessionSettings how = settings();
  how.odometry = OdometryUse::pose_with_gyro;
  std::vector<importers::TurnRate> rates;
  for (const Imu& imu : made.imu) rates.push_back({seconds_of(imu.stamp), imu.rate.z(), 4e-6});
  how.gyro_noise = importers::yaw_variance_per_second(rates);
  RobotSession live = session(how);
  const PoseReports reports = play(live, made, true);
  workflows::LocalizeRequest request = how.request;
  request.log = bag(made, true), request.start = how.start;
  expect_same(reports, workflows::localize(request).track);
}

TEST_F(Session, TakesFixesAndHeadingsAsLocalizeDoes) {
  const auto longitude = [](double x) { return 8.2 + x / 73300; };
  const auto latitude = [](double y) { return 48.75 + y / 111200; };
  std::string table = "type,x,y,position_sd\n";
  for (const Tree& tree : made_.trees)
    table += fmt::format("tree,{:.9f},{:.9f},0.03\n", longitude(tree.x), latitude(tree.y));
  write_file(file("places.csv"), table);
  workflows::ImportRequest import{.table = file("places.csv"), .map = file("utm.gpkg")};
  import.options.table_crs = "EPSG:4326", import.options.map_crs = "EPSG:32632";
  workflows::import_landmarks(import);
  SessionSettings how = settings();
  how.request.map = file("utm.gpkg");
  how.request.set = {"start_sd=3"};
  RobotSession live = session(how);
  live.take(placed("gps", 0.5, 1));

  MadeBag messages{made_frame(false, "base_link", "imu", 0, 0, 0),
                   made_frame(false, "base_link", "gps", 0.5, 0, 0)};
  PoseReports reports;
  const auto add = [&](PoseReports more) { std::ranges::move(more, std::back_inserter(reports)); };
  for (std::size_t i = 0; i < made_.odometry.size(); ++i) {
    const Odometry& o = made_.odometry[i];
    const double t = time_of(int(i)), yaw = made_.truth[i].yaw;
    Fix fix{.stamp = o.stamp, .frame = "gps", .latitude = latitude(made_.truth[i].y)};
    fix.longitude = longitude(made_.truth[i].x);
    fix.covariance = {4, 0, 0, 0, 4, 0, 0, 0, 9}, fix.covariance_type = 3;
    Imu imu{.stamp = o.stamp, .frame = "imu"};
    imu.orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    imu.orientation_covariance = {0, 0, 0, 0, 0, 0, 0, 0, 0.01};
    add(live.take(imu)), add(live.take(fix)), add(live.take(o));
    messages.push_back(made_odometry(false, t, o.pose.at.x(), o.pose.at.y(),
                                     2 * std::atan2(o.pose.turn.z(), o.pose.turn.w())));
    messages.push_back(made_fix(false, t, {.latitude = fix.latitude, .longitude = fix.longitude}));
    messages.push_back(
        made_imu(false, t, {.orientation_first = 0, .yaw = yaw, .yaw_variance = 0.01, .rate_first = -1}));
  }
  add(live.flush());
  write_rosbag2(folder_.path() / "fixes.db3", messages);
  workflows::LocalizeRequest request = how.request;
  request.log = file("fixes.db3"), request.start = how.start;
  expect_same(reports, workflows::localize(request).track);
  EXPECT_THAT(live.status().values, Contains(Pair("fixes", std::to_string(2 * made_.odometry.size()))));
}

TEST_F(Session, PublishesMapFromOdomSoThatOdomStaysTheParentOfTheRobot) {
  RobotSession live = session();
  std::size_t checked = 0;
  for (const PoseReport& report : play(live, made_)) {
    const auto odometry = std::ranges::find(made_.odometry, report.stamp, &Odometry::stamp);
    ASSERT_NE(odometry, made_.odometry.end());
    if (!report.map_from_odom) continue;
    const Eigen::Isometry3d map_from_base = Eigen::Translation3d(report.map_from_odom->at) *
                                            report.map_from_odom->turn *
                                            Eigen::Translation3d(odometry->pose.at) * odometry->pose.turn;
    const Pose2 there = importers::level_pose(map_from_base);
    EXPECT_LT((there.at() - report.at.pose.at()).norm(), 1e-9);
    EXPECT_NEAR(localization::wrap_angle(there.yaw - report.at.pose.yaw), 0, 1e-9);
    ++checked;
  }
  EXPECT_GT(checked, 200u);
}

TEST_F(Session, TwistsAreSpeedsUntilTheNextMessage) {
  SessionSettings how = settings();
  how.odometry = OdometryUse::twist;
  how.request.method = "odometry";
  RobotSession live = session(how);
  const PoseReports reports = play(live, made_);
  // The arcs of the speeds lead where the poses of the wheels lead, from the start.
  const Pose2 wheels{made_.odometry.back().pose.at.x(), made_.odometry.back().pose.at.y(), 0};
  const Eigen::Vector2d end = (Pose2{0, -10, 0} * wheels).at();
  EXPECT_LT((reports.back().at.pose.at() - end).norm(), 1e-9);
}

TEST_F(Session, CovariancesAreThoseOfTheMessageOfRos) {
  RobotSession live = session();
  const PoseReport report = play(live, made_).back();
  const Eigen::Matrix3d& c = report.at.covariance;
  EXPECT_EQ(report.covariance[0], c(0, 0));
  EXPECT_EQ(report.covariance[1], c(0, 1));
  EXPECT_EQ(report.covariance[5], c(0, 2));
  EXPECT_EQ(report.covariance[6], c(1, 0));
  EXPECT_EQ(report.covariance[7], c(1, 1));
  EXPECT_EQ(report.covariance[11], c(1, 2));
  EXPECT_EQ(report.covariance[30], c(2, 0));
  EXPECT_EQ(report.covariance[31], c(2, 1));
  EXPECT_EQ(report.covariance[35], c(2, 2));
  EXPECT_EQ(report.covariance[14], 0);
}

}  // namespace
}  // namespace waymark::test
