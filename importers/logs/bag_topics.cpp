// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/bag_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "importers/logs/robot_readings.hpp"

namespace waymark::importers {
namespace {

void add_pose(OdometryTopic& topic, double t, const Eigen::Isometry3d& pose, double yaw_variance) {
  if (!topic.poses.empty()) topic.jump_back = std::max(topic.jump_back, topic.poses.back().t - t);
  topic.poses.push_back({t, level_pose(pose)});
  constexpr double kAnyYaw = std::numbers::pi * std::numbers::pi;  // rad^2; nothing is known of such a yaw
  topic.unknown_yaws += !(yaw_variance >= 0 && yaw_variance < kAnyYaw);
}

void add_odometry(BagTopics& topics, const BagMessage& message) {
  BagOdometry one = read_odometry(message);
  OdometryTopic& topic = topics.odometry[std::string(message.topic)];
  if (topic.poses.empty()) topic.body = std::move(one.body);
  add_pose(topic, one.at.t, one.pose, one.yaw_variance);
}

void add_pose_of(BagTopics& topics, const BagMessage& message, bool has_covariance) {
  const BagPose one = read_pose(message, has_covariance);
  PoseTopic& topic = topics.poses[std::string(message.topic)];
  topic.type = message.type, topic.frame = one.at.frame;
  topic.odometry.body = "base_link";  // the message names none
  add_pose(topic.odometry, one.at.t, one.pose, one.yaw_variance);
}

/// Returns whether a frame is one of odometry by its name (REP 105), with or without a name of the robot.
bool is_of_odometry(std::string_view frame) {
  return frame.substr(frame.rfind('/') + 1).starts_with("odom");
}

void add_scan(BagTopics& topics, const BagMessage& message) {
  CdrReader in(message.bytes);
  BagStamp at = read_stamp(in, message.received);
  const double first = in.number<float>();
  in.number<float>();  // last angle
  const double step = in.number<float>();
  in.number<float>(), in.number<float>();  // time between beams and between scans
  const float min_range = in.number<float>(), max_range = in.number<float>();
  std::vector<float> ranges = in.floats(), intensities = in.floats();
  localization::LaserScan scan =
      laser_scan(first, step, min_range, max_range, std::move(ranges), std::move(intensities));
  ScanTopic& topic = topics.scans[std::string(message.topic)];
  if (topic.scans.empty()) topic.frame = std::move(at.frame);
  topic.scans.push_back({at.t, std::move(scan)});
}

void add_frames(BagTopics& topics, const BagMessage& message) {
  constexpr std::size_t kMinSize = 8 + 4 + 4 + 7 * 8;  // stamp, two empty names, transform
  CdrReader in(message.bytes);
  for (std::size_t n = in.count(kMinSize); n > 0; --n) {
    const BagStamp at = read_stamp(in, message.received);
    const std::string child = in.text();
    const Eigen::Isometry3d pose = read_transform(in);
    topics.frames.place(child, at.frame, pose);
    if (!is_of_odometry(at.frame)) continue;
    PoseTopic& moved = topics.moved[child];
    moved.type = message.topic, moved.frame = at.frame, moved.odometry.body = child;
    add_pose(moved.odometry, at.t, pose, 0);
  }
}

void add_imu(BagTopics& topics, const BagMessage& message) {
  topics.imus[std::string(message.topic)].readings.push_back(read_imu(message));
}

void add_fix(BagTopics& topics, const BagMessage& message) {
  BagFix one = read_fix(message);
  FixTopic& topic = topics.fixes[std::string(message.topic)];
  if (topic.frame.empty()) topic.frame = one.at.frame;
  if (one.is_fix)
    topic.fixes.push_back(std::move(one));
  else
    ++topic.without_fix;
}

void add_cloud(BagTopics& topics, const BagMessage& message) {
  const BagStamp at = read_cloud_stamp(message);
  CloudTopic& topic = topics.clouds[std::string(message.topic)];
  if (topic.clouds++ == 0) topic.frame = at.frame;
}

}  // namespace

bool OdometryTopic::lacks_yaw() const {
  const auto differs = [&](const localization::StampedPose& p) { return p.pose.yaw != poses[0].pose.yaw; };
  return 2 * unknown_yaws > poses.size() || (poses.size() > 1 && std::ranges::none_of(poses, differs));
}

void BagTopics::add(const BagMessage& message) {
  if (message.type == "nav_msgs/msg/Odometry")
    add_odometry(*this, message);
  else if (message.type == "sensor_msgs/msg/LaserScan")
    add_scan(*this, message);
  else if (message.type == "tf2_msgs/msg/TFMessage")
    add_frames(*this, message);
  else if (message.type == "geometry_msgs/msg/PoseWithCovarianceStamped")
    add_pose_of(*this, message, true);
  else if (message.type == "geometry_msgs/msg/PoseStamped")
    add_pose_of(*this, message, false);
  else if (message.type == "sensor_msgs/msg/Imu")
    add_imu(*this, message);
  else if (message.type == "sensor_msgs/msg/NavSatFix")
    add_fix(*this, message);
  else if (message.type == "sensor_msgs/msg/PointCloud2")
    add_cloud(*this, message);
  else
    ++others[{std::string(message.topic), std::string(message.type)}];
}

std::vector<std::string> BagTopics::choose_odometry(const std::vector<std::string>& wanted) {
  std::vector<std::string> remarks;
  const bool has_odometry = !odometry.empty();
  for (auto& [name, topic] : poses) {
    const bool is_wanted = std::ranges::find(wanted, name) != wanted.end();
    const std::size_t count = topic.odometry.poses.size();
    if (!is_wanted && (has_odometry || !is_of_odometry(topic.frame))) {
      others[{name, topic.type}] += count;
      continue;
    }
    remarks.push_back(fmt::format("{} poses of {} in the frame {} are taken as odometry of base_link", count,
                                  name, topic.frame));
    odometry[name] = std::move(topic.odometry);
  }
  const auto busiest = std::ranges::max_element(
      moved, {}, [](const auto& frame) { return frame.second.odometry.poses.size(); });
  if (odometry.empty() && busiest != moved.end() && busiest->second.odometry.poses.size() > 1) {
    PoseTopic& frame = busiest->second;
    const std::string name = fmt::format("{} ({} to {})", frame.type, frame.frame, busiest->first);
    remarks.push_back(fmt::format("the bag has no messages of odometry: {} transforms of {} are taken for it",
                                  frame.odometry.poses.size(), name));
    odometry[name] = std::move(frame.odometry);
  }
  poses.clear(), moved.clear();
  return remarks;
}

std::vector<std::string> BagTopics::names() const {
  std::vector<std::string> known;
  const auto add_of = [&](const auto& topics) {
    for (const auto& [name, topic] : topics) known.push_back(name);
  };
  add_of(odometry), add_of(scans), add_of(clouds), add_of(imus), add_of(fixes);
  return known;
}

std::string BagTopics::contents() const {
  constexpr std::size_t kMax = 8;
  std::vector<std::string> all;
  for (const auto& [name, topic] : imus)
    all.push_back(fmt::format("{} of sensor_msgs/msg/Imu ({})", name, topic.readings.size()));
  for (const auto& [what, count] : others)
    all.push_back(fmt::format("{} of {} ({})", what.first, what.second, count));
  if (all.empty()) return "it has no messages";
  const std::size_t more = all.size() > kMax ? all.size() - kMax : 0;
  all.resize(all.size() - more);
  return fmt::format("it has {}{}", fmt::join(all, ", "), more ? fmt::format(" and {} more", more) : "");
}

}  // namespace waymark::importers
