// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::importers {

/// One serialized message of a bag. The views are valid during the visit only.
struct BagMessage {
  std::string_view topic, type;  ///< "/scan", "sensor_msgs/msg/LaserScan"
  std::int64_t received = 0;     ///< ns since 1970, by the recorder
  std::string_view bytes;        ///< CDR, or a frame of zstd with it
};
using BagVisitor = std::function<void(const BagMessage&)>;

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n", kRos1Magic = "#ROSBAG V";

/// Visits the messages of a rosbag2 file with SQLite storage (.db3), in the order of the file.
/// Throws Error{input}.
void visit_rosbag2(const std::filesystem::path& file, const BagVisitor& visit);

/// Visits the messages of an MCAP file (https://mcap.dev/spec) in the order of the file; chunks may be
/// compressed by zstd or lz4. The type of messages in another encoding than CDR names it. Returns a remark if
/// the file is cut off, as when a recorder was killed; the messages before that are visited. Throws
/// Error{input} for records that contradict each other.
std::vector<std::string> visit_mcap(const std::filesystem::path& file, const BagVisitor& visit);

/// Returns whether a file is named like one of a bag of ROS 2: .db3 or .mcap, or one of them with .zstd
/// behind.
bool is_bag(const std::filesystem::path& file);
/// Returns whether a file begins like an MCAP file, whatever its name.
bool begins_like_mcap(const std::filesystem::path& file);
/// Returns whether a file begins like a bag of ROS 1.
bool begins_like_ros1(const std::filesystem::path& file);

/// Returns the files of a bag: `path` itself, or those of a folder in the order of their numbers.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

/// Visits the messages of the files of a bag one after another and returns the remarks on them. A file that
/// is compressed as a whole is unpacked in memory and into the temporary folder. Throws Error{input}.
std::vector<std::string> visit_bag(const std::filesystem::path& path, const BagVisitor& visit);

}  // namespace waymark::importers
