// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>
#include "importers/logs/bag_messages.hpp"
#include "importers/logs/frame_tree.hpp"
#include "localization/robot_log.hpp"
namespace waymark::importers {

/// Odometry of one topic.
struct OdometryTopic {
  std::string body = {};  ///< frame that the poses are of
  std::vector<localization::StampedPose> poses = {};
  std::size_t unknown_yaws = 0;  ///< poses that state no use of their yaw
  double jump_back = 0;          ///< s, most that a message is older than the one before it

  /// Returns whether the yaw is not measured: drivers then state a large variance, or leave it at 0.
  bool lacks_yaw() const;
};

/// Scans of one topic of 2-D scanners.
struct ScanTopic {
  std::string frame = {};
  std::vector<localization::LogEvent> scans = {};
};

struct ImuTopic {
  std::vector<BagImu> readings = {};
};

struct FixTopic {
  std::string frame = {};
  std::vector<BagFix> fixes = {};
  std::size_t without_fix = 0;  ///< messages
};

/// Point clouds of one topic, which are counted: together they do not fit into memory.
struct CloudTopic {
  std::string frame = {};
  std::size_t clouds = 0;
};

/// Poses of one topic, or of one frame that transforms move. They are odometry if they are stated in a frame
/// of odometry: those in a frame of a map jump where a localizer corrects them.
struct PoseTopic {
  std::string type = {};   ///< of the messages
  std::string frame = {};  ///< in which they are stated
  OdometryTopic odometry = {};
};

/// What the messages of a bag hold, by topic.
struct BagTopics {
  std::map<std::string, OdometryTopic> odometry = {};
  std::map<std::string, ScanTopic> scans = {};
  std::map<std::string, ImuTopic> imus = {};
  std::map<std::string, FixTopic> fixes = {};
  std::map<std::string, CloudTopic> clouds = {};
  std::map<std::string, PoseTopic> poses = {};  ///< of geometry_msgs
  std::map<std::string, PoseTopic> moved = {};  ///< frames below one of odometry, by name
  FrameTree frames = {};
  std::map<std::pair<std::string, std::string>, std::size_t> others = {};  ///< not read, by topic and type

  /// Adds a message. Throws std::runtime_error for one that cannot be read.
  void add(const BagMessage& message);

  /// Chooses among poses and transforms what is odometry, once all messages are added; returns remarks.
  /// - Poses of the topics that are `wanted`.
  /// - Without messages of odometry, poses in a frame of odometry; without such, the frame that the largest
  ///   number of transforms move.
  /// The other poses are not read.
  std::vector<std::string> choose_odometry(const std::vector<std::string>& wanted);

  /// Returns the names of the topics that are read.
  std::vector<std::string> names() const;
  /// Returns a sentence on the topics without odometry, scans, clouds and fixes, with their numbers of
  /// messages.
  std::string contents() const;
};

}  // namespace waymark::importers
