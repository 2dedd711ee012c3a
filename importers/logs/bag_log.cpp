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
#include "importers/logs/bag_imu.hpp"
#include "importers/logs/bag_messages.hpp"
#include "importers/logs/bag_topics.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/odometry_steps.hpp"
#include "importers/logs/robot_readings.hpp"
#include "importers/logs/zstd.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

/// Point clouds of one topic that are read in a second pass, as they do not fit into memory together.
struct ChosenClouds {
  std::string topic;
  Eigen::Isometry3d body_from_sensor = Eigen::Isometry3d::Identity();
};

class BagReader {
 public:
  BagReader(const std::filesystem::path& path, const std::vector<std::string>& topics)
      : path_(path), wanted_(topics) {}

  void read(const BagMessage& message) {
    guarded(message, [&](const BagMessage& plain) { topics_.add(plain); });
  }

  /// Chooses what is odometry, once all messages are read.
  void choose_odometry() { log_.remarks = topics_.choose_odometry(wanted_); }

  /// Returns the topic of point clouds to read with read_clouds(), if there is any.
  std::optional<ChosenClouds> choose_clouds() {
    const auto chosen =
        largest(topics_.clouds, "point clouds are", [](const CloudTopic& topic) { return topic.clouds; });
    if (chosen == topics_.clouds.end()) return {};
    const auto place = place_of(chosen->second.frame, body());
    return ChosenClouds{chosen->first, place};
  }

  /// Reads a point cloud of the chosen topic and keeps what is detected in it.
  void read_cloud_of(const ChosenClouds& chosen, const localization::PointDetector& detect,
                     const BagMessage& message) {
    if (message.topic != chosen.topic || message.type != "sensor_msgs/msg/PointCloud2") return;
    guarded(message, [&](const BagMessage& plain) {
      BagCloud cloud = read_cloud(plain);
      const localization::Pose2 mount = level_pose(chosen.body_from_sensor);
      const Eigen::Matrix3f upright =
          (Eigen::AngleAxisd(-mount.yaw, Eigen::Vector3d::UnitZ()) * chosen.body_from_sensor.linear())
              .cast<float>();
      for (Eigen::Vector3f& point : cloud.points) point = upright * point;
      log_.events.push_back({cloud.at.t, detect({.robot_from_sensor = mount,
                                                 .points = std::move(cloud.points),
                                                 .intensities = std::move(cloud.intensities)})});
    });
  }

  void leave_clouds_out(const std::string& topic) {
    log_.remarks.push_back(
        fmt::format("{} point clouds of {} are not used: the map has no landmarks that 3-D scans show",
                    topics_.clouds[topic].clouds, topic));
  }

  void check() const {
    if (topics_.odometry.empty() && topics_.scans.empty() && topics_.fixes.empty() && topics_.clouds.empty())
      throw Error(
          ErrorCode::input,
          unsound_ ? fmt::format("no message of the bag can be read; the first bad one is {}", first_unsound_)
                   : "the bag has neither odometry nor scans",
          path_.string(),
          fmt::format(
              "Odometry of nav_msgs, poses and transforms in a frame odom, and LaserScan, PointCloud2, "
              "Imu and NavSatFix of sensor_msgs are read; {}",
              topics_.contents()));
    check_wanted();
  }

  localization::RobotLog take(std::vector<std::string> remarks) {
    std::ranges::move(log_.remarks, std::back_inserter(remarks));
    log_.remarks = std::move(remarks);
    if (unsound_)
      log_.remarks.push_back(fmt::format("{} messages cannot be read and are skipped, the first is {}",
                                         unsound_, first_unsound_));
    for (const auto& [what, count] : topics_.others)
      log_.remarks.push_back(
          fmt::format("{} messages of type {} of {} are skipped", count, what.second, what.first));
    const std::string base = body();
    const auto scans =
        largest(topics_.scans, "scans are", [](const ScanTopic& topic) { return topic.scans.size(); });
    if (scans != topics_.scans.end()) add_scans(scans->second, base);
    add_fixes(base);
    std::vector<localization::StampedPose> poses;
    const auto odometry = chosen_odometry();
    bool lacks_yaw = false;
    if (odometry != topics_.odometry.end()) {
      lacks_yaw = odometry->second.lacks_yaw();
      constexpr double kMaxDelay = 1;  // seconds that messages may come late
      if (const double back = odometry->second.jump_back; back > kMaxDelay)
        log_.remarks.push_back(fmt::format(
            "the clock of {} jumps back by {:.3g} s, as when a simulator starts again or a bag is "
            "played in a loop: the drives are mixed; split the recording there",
            odometry->first, back));
      poses = std::move(odometry->second.poses);
      std::ranges::stable_sort(poses, {}, &localization::StampedPose::t);
    }
    add_imu(base, poses, lacks_yaw);
    add_odometry_steps(log_, std::move(poses));
    localization::clean_log(log_);
    return std::move(log_);
  }

 private:
  template <class Read>
  void guarded(const BagMessage& message, const Read& read) {
    try {
      // rosbag2 compresses single messages in its mode `message`.
      const std::string content = is_zstd(message.bytes) ? unpacked_zstd(message.bytes) : std::string();
      BagMessage plain = message;
      if (!content.empty()) plain.bytes = content;
      read(plain);
    } catch (const std::runtime_error& problem) {
      if (++unsound_ == 1) first_unsound_ = fmt::format("of topic {}: {}", message.topic, problem.what());
    }
  }

  void check_wanted() const {
    const std::vector<std::string> known = topics_.names();
    for (const std::string& name : wanted_)
      if (std::ranges::find(known, name) == known.end())
        throw Error(ErrorCode::usage, "the bag has no messages that are read of the topic " + name,
                    path_.string(), fmt::format("it has them of {}", fmt::join(known, ", ")));
  }

  // A bag may hold raw and filtered odometry, or several scanners. Returns the end if there is no topic.
  template <class Topic, class Count>
  typename std::map<std::string, Topic>::iterator largest(std::map<std::string, Topic>& topics,
                                                          const char* what, const Count& count) {
    if (topics.empty()) return topics.end();
    const auto is_wanted = [&](const auto& topic) {
      return std::ranges::find(wanted_, topic.first) != wanted_.end();
    };
    if (std::ranges::count_if(topics, is_wanted) > 1)
      throw Error(ErrorCode::usage, fmt::format("several of the topics that {} read from are named", what),
                  path_.string(), "name one topic of odometry, one of scans, and one of each other kind");
    auto chosen = std::ranges::find_if(topics, is_wanted);
    const char* why = "as asked";
    if (chosen == topics.end()) {
      chosen = std::ranges::max_element(topics, {}, [&](const auto& topic) { return count(topic.second); });
      why = "which has the most messages";
    }
    std::vector<std::string> unused;
    for (const auto& [name, topic] : topics)
      if (name != chosen->first) unused.push_back(name);
    if (!unused.empty())
      log_.remarks.push_back(
          fmt::format("{} read from {}, {}; not from {}", what, chosen->first, why, fmt::join(unused, ", ")));
    return chosen;
  }

  /// Chosen once, as the choice makes a remark.
  std::map<std::string, OdometryTopic>::iterator chosen_odometry() {
    if (!odometry_chosen_)
      odometry_chosen_ =
          largest(topics_.odometry, "odometry is", [](const auto& topic) { return topic.poses.size(); });
    return *odometry_chosen_;
  }
  std::string body() {
    const auto odometry = chosen_odometry();
    return odometry == topics_.odometry.end() ? "base_link" : odometry->second.body;
  }

  Eigen::Isometry3d place_of(const std::string& sensor, const std::string& body) {
    const auto body_from_sensor = topics_.frames.transform(body, sensor);
    if (!body_from_sensor)
      log_.remarks.push_back(fmt::format(
          "no transform leads from {} to {}: the sensor is taken to be in the middle of the robot", sensor,
          body));
    return body_from_sensor.value_or(Eigen::Isometry3d::Identity());
  }

  void add_scans(ScanTopic& topic, const std::string& body) {
    const Eigen::Isometry3d place = place_of(topic.frame, body);
    if (!is_level(place))
      throw Error(ErrorCode::input,
                  fmt::format("the scanner {} is tilted by {:.0f} degrees", topic.frame,
                              std::acos(std::abs(place(2, 2))) * 180 / std::numbers::pi),
                  path_.string(), "scans of level scanners are read; --topic names another");
    for (localization::LogEvent& event : topic.scans)
      mount(std::get<localization::LaserScan>(event.what), place);
    std::ranges::move(topic.scans, std::back_inserter(log_.events));
  }

  void add_fixes(const std::string& body) {
    const auto chosen = largest(topics_.fixes, "satellite fixes are",
                                [](const FixTopic& topic) { return topic.fixes.size() + topic.without_fix; });
    if (chosen == topics_.fixes.end()) return;
    const FixTopic& topic = chosen->second;
    if (topic.without_fix)
      log_.remarks.push_back(fmt::format("{} messages of {} are without a satellite fix and are skipped",
                                         topic.without_fix, chosen->first));
    if (topic.fixes.empty()) return;
    const double arm = place_of(topic.frame, body).translation().head<2>().norm();
    std::size_t unstated = 0;
    for (const BagFix& fix : topic.fixes) {
      unstated += !fix.covariance;
      log_.events.push_back({fix.at.t, fix_of_antenna(fix.longitude, fix.latitude, fix.covariance, arm)});
    }
    log_.fix_crs = "EPSG:4326";
    std::string remark =
        fmt::format("{} satellite fixes are read from {}", topic.fixes.size(), chosen->first);
    if (unstated) remark += fmt::format("; {} state no covariance and get 3 m", unstated);
    if (arm > 0)
      remark += fmt::format("; the antenna is {:.2g} m from the robot's middle, an error that is added", arm);
    log_.remarks.push_back(remark);
  }

  void add_imu(const std::string& body, std::vector<localization::StampedPose>& poses, bool lacks_yaw) {
    const auto chosen = largest(topics_.imus, "inertial readings are",
                                [](const ImuTopic& topic) { return topic.readings.size(); });
    if (chosen == topics_.imus.end()) return;
    std::vector<BagImu>& readings = chosen->second.readings;
    if (readings.empty()) return;  // none of its messages is sound
    std::ranges::stable_sort(readings, {}, [](const BagImu& one) { return one.at.t; });
    const Eigen::Matrix3d turn = place_of(readings[0].at.frame, body).linear();
    add_turn_rates(log_, chosen->first, readings, turn, poses, lacks_yaw);
    add_headings(log_, chosen->first, readings, turn);
  }

  const std::filesystem::path& path_;
  const std::vector<std::string>& wanted_;
  localization::RobotLog log_;
  std::optional<std::map<std::string, OdometryTopic>::iterator> odometry_chosen_;
  BagTopics topics_;
  std::size_t unsound_ = 0;
  std::string first_unsound_;
};

/// Returns whether a detector of 3-D scans makes a type that the map holds, or one is named.
bool shows_in_clouds(const TypeRegistry& types, const LogImport& how) {
  if (!how.point_detectors.empty()) return true;
  const auto is_held = [&](const std::string& name) {
    const auto type = localization::type_in_map(types, name);
    return type &&
           (how.held_types.empty() || std::ranges::find(how.held_types, *type) != how.held_types.end());
  };
  return std::ranges::any_of(localization::point_detectors(),
                             [&](const localization::DetectorSpec& detector) {
                               return std::ranges::any_of(detector.types, is_held);
                             });
}

}  // namespace

localization::RobotLog import_bag_log(const std::filesystem::path& path, const TypeRegistry& types,
                                      const LogImport& how) {
  BagReader reader(path, how.topics);
  std::vector<std::string> remarks =
      visit_bag(path, [&](const BagMessage& message) { reader.read(message); });
  reader.choose_odometry();
  reader.check();
  if (const auto clouds = reader.choose_clouds()) {
    if (shows_in_clouds(types, how)) {
      const localization::PointDetector detect =
          localization::make_point_detector(types, how.held_types, how.point_detectors);
      visit_bag(path, [&](const BagMessage& message) { reader.read_cloud_of(*clouds, detect, message); });
    } else {
      reader.leave_clouds_out(clouds->topic);
    }
  }
  return reader.take(std::move(remarks));
}

}  // namespace waymark::importers
