// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/bag_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "importers/logs/robot_readings.hpp"

namespace waymark::importers {
namespace {

void add_odometry(BagTopics& topics, const BagMessage& message) {
  BagOdometry one = read_odometry(message);
  OdometryTopic& topic = topics.odometry[std::string(message.topic)];
  if (topic.poses.empty()) topic.body = std::move(one.body);
  if (!topic.poses.empty()) topic.jump_back = std::max(topic.jump_back, topic.poses.back().t - one.at.t);
  topic.poses.push_back({one.at.t, level_pose(one.pose)});
  constexpr double kAnyYaw = std::numbers::pi * std::numbers::pi;  // rad^2; nothing is known of such a yaw
  topic.unknown_yaws += !(one.yaw_variance >= 0 && one.yaw_variance < kAnyYaw);
}

void add_scan(BagTopics& topics, const BagMessage& message) {
  CdrReader in(message.bytes);
  BagStamp at = read_stamp(in, message.received);
  const double first = in.number<float>();
  in.number<float>();  // last angle
  const double step = in.number<float>();
  in.number<float>(), in.number<float>();  // time between beams and between scans
  const float min_range = in.number<float>(), max_range = in.number<float>();
  std::vector<float> ranges = in.floats();
  localization::LaserScan scan = laser_scan(first, step, min_range, max_range, std::move(ranges));
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
    topics.frames.place(child, at.frame, read_transform(in));
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
  else if (message.type == "sensor_msgs/msg/Imu")
    add_imu(*this, message);
  else if (message.type == "sensor_msgs/msg/NavSatFix")
    add_fix(*this, message);
  else if (message.type == "sensor_msgs/msg/PointCloud2")
    add_cloud(*this, message);
  else
    ++others[{std::string(message.topic), std::string(message.type)}];
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
