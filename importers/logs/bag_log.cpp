// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/error.hpp"
#include "importers/logs/bag_file.hpp"
#include "importers/logs/cdr.hpp"
#include "importers/logs/frame_tree.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/odometry_steps.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

constexpr double kMaxTilt = 0.2;  // rad: a level scan 10 m away is then 2 m higher or lower

struct Stamp {
  double t = 0;
  std::string frame;
};
struct OdometryTopic {
  std::string body;  // frame that the poses are of
  std::vector<localization::StampedPose> poses;
};
struct ScanTopic {
  std::string frame;
  std::vector<localization::LogEvent> scans;
};

Eigen::Isometry3d transform(CdrReader& in) {
  Eigen::Vector3d at;
  for (double& v : at) v = in.number<double>();
  Eigen::Quaterniond turn;
  for (double& v : turn.coeffs()) v = in.number<double>();  // x y z w, as Eigen keeps them
  if (!(at.allFinite() && std::abs(turn.norm() - 1) < 0.1))
    throw std::runtime_error("a pose is not finite or its quaternion is not of length 1");
  return Eigen::Translation3d(at) * turn.normalized();
}

localization::Pose2 level(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(), std::atan2(pose(1, 0), pose(0, 0))};
}

// Seen from above, the beams of a scanner that hangs upside down run from right to left in the other order.
void turn_over(localization::LaserScan& scan) {
  scan.first_angle = -(scan.first_angle + scan.angle_step * static_cast<double>(scan.ranges.size() - 1));
  std::ranges::reverse(scan.ranges);
}

class BagReader {
 public:
  BagReader(const std::filesystem::path& path, const std::vector<std::string>& topics)
      : path_(path), wanted_(topics) {}

  void read(const BagMessage& message) {
    try {
      if (message.type == "nav_msgs/msg/Odometry")
        odometry(message);
      else if (message.type == "sensor_msgs/msg/LaserScan")
        scan(message);
      else if (message.type == "tf2_msgs/msg/TFMessage")
        frames(message);
      else
        ++others_[std::string(message.type)];
    } catch (const std::runtime_error& problem) {
      if (++unsound_ == 1) first_unsound_ = fmt::format("of topic {}: {}", message.topic, problem.what());
    }
  }

  localization::RobotLog take(std::vector<std::string> remarks) {
    log_.remarks = std::move(remarks);
    if (odometry_.empty() && scans_.empty())
      throw Error(
          ErrorCode::input,
          unsound_ ? fmt::format("no message of the bag can be read; the first bad one is {}", first_unsound_)
                   : "the bag has neither odometry nor scans",
          path_.string(), "nav_msgs/msg/Odometry and sensor_msgs/msg/LaserScan are read");
    check_wanted();
    if (unsound_)
      log_.remarks.push_back(fmt::format("{} messages cannot be read and are skipped, the first is {}",
                                         unsound_, first_unsound_));
    for (const auto& [type, count] : others_)
      log_.remarks.push_back(fmt::format("{} messages of type {} are skipped", count, type));
    std::string body = "base_link";
    std::vector<localization::StampedPose> poses;
    if (OdometryTopic* chosen = largest(odometry_, "odometry is", &OdometryTopic::poses)) {
      body = chosen->body;
      poses = std::move(chosen->poses);
    }
    if (ScanTopic* chosen = largest(scans_, "scans are", &ScanTopic::scans)) mount(*chosen, body);
    add_odometry_steps(log_, std::move(poses));
    localization::clean_log(log_);
    return std::move(log_);
  }

 private:
  static Stamp stamp(CdrReader& in, std::int64_t received) {
    const auto seconds = in.number<std::int32_t>();
    const auto nanoseconds = in.number<std::uint32_t>();
    const double t = seconds + nanoseconds / 1e9;
    return {t != 0 ? t : static_cast<double>(received) / 1e9, in.text()};  // 0: drivers that set no stamp
  }

  void odometry(const BagMessage& message) {
    CdrReader in(message.bytes);
    const Stamp at = stamp(in, message.received);
    std::string body = in.text();
    const Eigen::Isometry3d pose = transform(in);
    OdometryTopic& topic = odometry_[std::string(message.topic)];
    if (topic.poses.empty()) topic.body = std::move(body);
    topic.poses.push_back({at.t, level(pose)});
  }

  void scan(const BagMessage& message) {
    CdrReader in(message.bytes);
    Stamp at = stamp(in, message.received);
    const double first = in.number<float>();
    in.number<float>();  // last angle
    const double step = in.number<float>();
    in.number<float>(), in.number<float>();  // time between beams and between scans
    const float min_range = in.number<float>(), max_range = in.number<float>();
    std::vector<float> ranges = in.floats();
    if (!(std::isfinite(first) && std::abs(step) > 0 && std::isfinite(step) && max_range > 0) ||
        ranges.empty())
      throw std::runtime_error("a scan has no beams, or its angles or ranges are not finite");
    for (float& r : ranges)
      if (!(r >= min_range)) r = 0;
    ScanTopic& topic = scans_[std::string(message.topic)];
    if (topic.scans.empty()) topic.frame = std::move(at.frame);
    topic.scans.push_back({at.t, localization::LaserScan{.robot_from_sensor = {},
                                                         .first_angle = first,
                                                         .angle_step = step,
                                                         .ranges = std::move(ranges),
                                                         .max_range = max_range}});
  }

  void frames(const BagMessage& message) {
    constexpr std::size_t kMinSize = 8 + 4 + 4 + 7 * 8;  // stamp, two empty names, transform
    CdrReader in(message.bytes);
    for (std::size_t n = in.count(kMinSize); n > 0; --n) {
      const Stamp at = stamp(in, message.received);
      const std::string child = in.text();
      frames_.place(child, at.frame, transform(in));
    }
  }

  void check_wanted() const {
    std::vector<std::string> known;
    for (const auto& [name, topic] : odometry_) known.push_back(name);
    for (const auto& [name, topic] : scans_) known.push_back(name);
    for (const std::string& name : wanted_)
      if (std::ranges::find(known, name) == known.end())
        throw Error(ErrorCode::usage, "the bag has no odometry and no scans of the topic " + name,
                    path_.string(), fmt::format("it has them of {}", fmt::join(known, ", ")));
  }

  // A bag may hold raw and filtered odometry, or several scanners.
  template <class Topic, class Member>
  Topic* largest(std::map<std::string, Topic>& topics, const char* what, Member member) {
    if (topics.empty()) return nullptr;
    const auto is_wanted = [&](const auto& topic) {
      return std::ranges::find(wanted_, topic.first) != wanted_.end();
    };
    if (std::ranges::count_if(topics, is_wanted) > 1)
      throw Error(ErrorCode::usage, fmt::format("several of the topics that {} read from are named", what),
                  path_.string(), "name one topic of odometry and one of scans");
    auto chosen = std::ranges::find_if(topics, is_wanted);
    const char* why = "as asked";
    if (chosen == topics.end()) {
      chosen = std::ranges::max_element(
          topics, {}, [&](const auto& topic) { return std::invoke(member, topic.second).size(); });
      why = "which has the most messages";
    }
    std::vector<std::string> unused;
    for (const auto& [name, topic] : topics)
      if (name != chosen->first) unused.push_back(name);
    if (!unused.empty())
      log_.remarks.push_back(
          fmt::format("{} read from {}, {}; not from {}", what, chosen->first, why, fmt::join(unused, ", ")));
    return &chosen->second;
  }

  void mount(ScanTopic& topic, const std::string& body) {
    const auto body_from_sensor = frames_.transform(body, topic.frame);
    if (!body_from_sensor)
      log_.remarks.push_back(fmt::format(
          "no transform leads from {} to {}: the scanner is taken to be in the middle of the robot",
          topic.frame, body));
    const Eigen::Isometry3d place = body_from_sensor.value_or(Eigen::Isometry3d::Identity());
    if (!(std::abs(place(2, 2)) >= std::cos(kMaxTilt)))
      throw Error(ErrorCode::input,
                  fmt::format("the scanner {} is tilted by {:.0f} degrees", topic.frame,
                              std::acos(std::abs(place(2, 2))) * 180 / std::numbers::pi),
                  path_.string(), "scans of level scanners are read; --topic names another");
    for (localization::LogEvent& event : topic.scans) {
      auto& scan = std::get<localization::LaserScan>(event.what);
      scan.robot_from_sensor = level(place);
      if (place(2, 2) < 0) turn_over(scan);
    }
    log_.events = std::move(topic.scans);
  }

  const std::filesystem::path& path_;
  const std::vector<std::string>& wanted_;
  localization::RobotLog log_;
  std::map<std::string, OdometryTopic> odometry_;
  std::map<std::string, ScanTopic> scans_;
  FrameTree frames_;
  std::map<std::string, std::size_t> others_;
  std::size_t unsound_ = 0;
  std::string first_unsound_;
};

}  // namespace

std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    if (entry.path().extension() == ".db3" || entry.path().extension() == ".mcap")
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

localization::RobotLog import_bag_log(const std::filesystem::path& path,
                                      const std::vector<std::string>& topics) {
  BagReader reader(path, topics);
  const BagVisitor visit = [&](const BagMessage& message) { reader.read(message); };
  std::vector<std::string> remarks;
  for (const std::filesystem::path& file : bag_files(path)) {
    if (file.extension() == ".mcap")
      std::ranges::move(visit_mcap(file, visit), std::back_inserter(remarks));
    else
      visit_rosbag2(file, visit);
  }
  return reader.take(std::move(remarks));
}

}  // namespace waymark::importers
