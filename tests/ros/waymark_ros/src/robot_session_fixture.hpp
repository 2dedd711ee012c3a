// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/locked_folder.hpp"
#include "core/random.hpp"
#include "ros/waymark_ros/src/robot_session.hpp"
#include "tests/importers/made_bag.hpp"
#include "workflows/mapping/import_landmarks.hpp"
namespace waymark::test {
using namespace waymark::ros;
using localization::Pose2;

inline constexpr double kStep = 0.25;        // s between odometry messages and scans
inline constexpr double kWheelScale = 1.02;  // what the wheels count too much: the landmarks must correct it
inline constexpr double kMount = 0.3;        // m from the robot's middle to the scanner, forward
inline constexpr Stamp kEpoch = 1700000000;  // s

inline Stamp stamp_of(double t) {
  return static_cast<Stamp>(std::llround(t * 1e3)) * 1'000'000;  // whole milliseconds
}

/// Seconds of a message of a recording, as a double that is read back as the same stamp.
inline double time_of(int step) {
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

inline std::vector<float> scan_of(const std::vector<Tree>& trees, const Pose2& map_from_sensor, double first,
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

inline MadeRecording record(int steps) {
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
inline const MadeRecording& recording() {
  static const MadeRecording made = record(120);
  return made;
}

inline StaticTransform placed(const std::string& child, double x, double z) {
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

}  // namespace waymark::test
