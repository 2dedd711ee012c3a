// SPDX-License-Identifier: Apache-2.0
#include "ros/waymark_ros/src/robot_session.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <numbers>

#include "core/atomic_file.hpp"
#include "core/locked_folder.hpp"
#include "core/random.hpp"
#include "importers/logs/gyro_yaw.hpp"
#include "tests/importers/made_bag.hpp"
#include "workflows/mapping/import_landmarks.hpp"

namespace waymark::test {
using namespace waymark::ros;
namespace {

using localization::Pose2;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

constexpr double kStep = 0.25;        // s between odometry messages and scans
constexpr double kWheelScale = 1.02;  // what the wheels count too much: the landmarks must correct it
constexpr double kMount = 0.3;        // m from the robot's middle to the scanner, forward
constexpr Stamp kEpoch = 1700000000;  // s

Stamp stamp_of(double t) {
  return static_cast<Stamp>(std::llround(t * 1e3)) * 1'000'000;  // whole milliseconds
}
/// Seconds of a message of a recording, as a double that is read back as the same stamp.
double time_of(int step) {
  return double(kEpoch) + kStep * step;
}

struct Tree {
  double x = 0, y = 0, radius = 0;
};

/// A robot on a circle in a wood, with odometry, a laser scanner, a gyro and a satellite receiver.
struct MadeRecording {
  std::vector<Tree> trees;
  std::vector<Odometry> odometry;
  std::vector<Scan> scans;
  std::vector<Imu> imu;
  std::vector<Fix> fixes;
  std::vector<Pose2> truth;  ///< at the times of the odometry
};

std::vector<float> scan_of(const std::vector<Tree>& trees, const Pose2& map_from_sensor, double first,
                           double step, std::size_t beams) {
  std::vector<float> ranges(beams, std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle = map_from_sensor.yaw + first + step * double(i);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    for (const Tree& tree : trees) {
      const Eigen::Vector2d to = Eigen::Vector2d(tree.x, tree.y) - map_from_sensor.at();
      const double middle = along.dot(to),
                   squares = tree.radius * tree.radius - (to.squaredNorm() - middle * middle);
      if (middle > 0 && squares > 0) ranges[i] = std::min(ranges[i], float(middle - std::sqrt(squares)));
    }
  }
  return ranges;
}

MadeRecording record(int steps) {
  MadeRecording made;
  Random random(7, "wood");
  while (made.trees.size() < 70) {
    const Tree tree{random.uniform(-22, 22), random.uniform(-22, 22), random.uniform(0.12, 0.3)};
    if (std::abs(std::hypot(tree.x, tree.y) - 10) > 1) made.trees.push_back(tree);
  }
  Pose2 truth{0, -10, 0}, wheels;
  for (int i = 0; i <= steps; ++i) {
    made.truth.push_back(truth);
    Odometry odometry{.stamp = stamp_of(time_of(i)), .frame = "odom", .body = "base_link"};
    odometry.pose.at = {wheels.x, wheels.y, 0};
    odometry.pose.turn = Eigen::AngleAxisd(wheels.yaw, Eigen::Vector3d::UnitZ());
    odometry.forward = 0.8 * kWheelScale, odometry.turn = 0.08;
    made.odometry.push_back(odometry);
    const double first = -2.2, step = std::numbers::pi / 720;
    const Pose2 sensor = truth * Pose2{kMount, 0, 0};
    made.scans.push_back({.stamp = stamp_of(time_of(i)),
                          .frame = "laser",
                          .angle_min = float(first),
                          .angle_increment = float(step),
                          .range_min = 0.1f,
                          .range_max = 30,
                          .ranges = scan_of(made.trees, sensor, float(first), float(step), 1009)});
    for (int k = 0; k < 5; ++k) {
      Imu imu{.stamp = stamp_of(time_of(i) + 0.05 * k), .frame = "imu"};
      imu.rate = {0, 0, 0.08 + 0.002 * random.normal()};
      imu.rate_covariance = {0, 0, 0, 0, 0, 0, 0, 0, 4e-6};
      made.imu.push_back(imu);
    }
    truth = truth * localization::twist_motion(0.8, 0, 0.08, kStep, {}).step;
    wheels = wheels * localization::twist_motion(0.8 * kWheelScale, 0, 0.08, kStep, {}).step;
  }
  return made;
}

/// The same recording for all tests.
const MadeRecording& recording() {
  static const MadeRecording made = record(120);
  return made;
}

StaticTransform placed(const std::string& child, double x, double z) {
  return {.parent = "base_link", .child = child, .parent_from_child = {.at = {x, 0, z}}};
}

class Session : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string table = "type,x,y,z,diameter,position_sd\n";
    for (const Tree& tree : made_.trees)
      table += "tree," + std::to_string(tree.x) + ',' + std::to_string(tree.y) + ",0," +
               std::to_string(2 * tree.radius) + ",0.03\n";
    write_file(file("trees.csv"), table);
    workflows::ImportRequest import{.table = file("trees.csv"), .map = file("map.gpkg")};
    import.options.table_crs = "local";
    workflows::import_landmarks(import);
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  SessionSettings settings() const {
    SessionSettings settings;
    settings.request.map = file("map.gpkg");
    settings.start = "0,-10,0";
    return settings;
  }
  RobotSession session(const SessionSettings& settings) const {
    RobotSession made(settings);
    made.take(placed("laser", kMount, 0.3));
    made.take(placed("imu", 0, 0.3));
    return made;
  }
  RobotSession session() const { return session(settings()); }

  /// Gives a session all messages in the order of their times, and returns all reports.
  static PoseReports play(RobotSession& session, const MadeRecording& made, bool with_imu = false) {
    PoseReports all;
    const auto add = [&](PoseReports more) { std::ranges::move(more, std::back_inserter(all)); };
    for (std::size_t i = 0; i < made.odometry.size(); ++i) {
      add(session.take(made.scans[i]));  // of the same time as the odometry, and received before it
      add(session.take(made.odometry[i]));
      for (std::size_t k = 0; with_imu && k < 5; ++k) add(session.take(made.imu[5 * i + k]));
    }
    add(session.flush());
    return all;
  }

  /// The same messages as a recording of ROS 2, in a file.
  std::string bag(const MadeRecording& made, bool with_imu = false) const {
    MadeBag messages{made_frame(false, "base_link", "laser", kMount, 0, 0),
                     made_frame(false, "base_link", "imu", 0, 0, 0)};
    for (std::size_t i = 0; i < made.odometry.size(); ++i) {
      const Odometry& o = made.odometry[i];
      const Scan& s = made.scans[i];
      const double t = time_of(int(i));
      messages.push_back(made_odometry(false, t, o.pose.at.x(), o.pose.at.y(),
                                       2 * std::atan2(o.pose.turn.z(), o.pose.turn.w())));
      messages.push_back(made_scan(false, t, s.angle_min, s.angle_increment, s.ranges));
      for (int k = 0; with_imu && k < 5; ++k)
        messages.push_back(made_imu(
            false, t + 0.05 * k, {.rate = made.imu[5 * i + std::size_t(k)].rate.z(), .rate_variance = 4e-6}));
    }
    write_rosbag2(folder_.path() / "made.db3", messages);
    return file("made.db3");
  }

  /// Compares reports with the track of localize() for the recording.
  static void expect_same(const PoseReports& reports, const localization::Track& track) {
    ASSERT_EQ(reports.size(), track.rows.size());
    for (std::size_t i = 0; i < reports.size(); ++i) {
      const localization::TrackRow& row = track.rows[i];
      ASSERT_NEAR(reports[i].at.pose.x, row.at.pose.x, 1e-9) << i;
      ASSERT_NEAR(reports[i].at.pose.y, row.at.pose.y, 1e-9) << i;
      ASSERT_NEAR(localization::wrap_angle(reports[i].at.pose.yaw - row.at.pose.yaw), 0, 1e-9) << i;
      ASSERT_LT((reports[i].at.covariance - row.at.covariance).norm(), 1e-9) << i;
      ASSERT_EQ(reports[i].matched, row.matched) << i;
      ASSERT_EQ(reports[i].rejected, row.rejected) << i;
      ASSERT_EQ(seconds_of(reports[i].stamp), row.t) << i;
    }
  }

  const MadeRecording& made_ = recording();
  LockedFolder folder_{std::filesystem::temp_directory_path()};
};

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

TEST_F(Session, GapsInTheOdometryAreCounted) {
  RobotSession live = session();
  for (const std::size_t i : {0u, 1u, 9u, 10u}) static_cast<void>(live.take(made_.odometry[i]));
  static_cast<void>(live.flush());
  EXPECT_THAT(live.status().values, Contains(Pair("gaps in the odometry", "1")));
  EXPECT_THAT(live.status().values, Contains(Pair("longest gap, s", "2.000000")));
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
