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
  std::string_view bytes;        ///< CDR
};
using BagVisitor = std::function<void(const BagMessage&)>;

/// Visits the messages of a rosbag2 file with SQLite storage (.db3), in the order of the file.
/// Throws Error{input}.
void visit_rosbag2(const std::filesystem::path& file, const BagVisitor& visit);

/// Visits the messages of an MCAP file (https://mcap.dev/spec) in the order of the file; chunks may be
/// compressed by zstd or lz4. Returns a remark if the file is cut off, as when a recorder was killed; the
/// messages before that are visited. Throws Error{input} for records that contradict each other.
std::vector<std::string> visit_mcap(const std::filesystem::path& file, const BagVisitor& visit);

/// Returns the files of a bag: `path` itself, or the .db3 and .mcap files of a folder by name.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

}  // namespace waymark::importers
