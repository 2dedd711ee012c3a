// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>

#include "core/error.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "importers/logs/bag_file.hpp"

namespace waymark::importers {
namespace {

struct BagTopic {
  std::string name, type;
};

}  // namespace

void visit_rosbag2(const std::filesystem::path& file, const BagVisitor& visit) {
  using namespace geodb;
  const sqlite::Database bag(file, sqlite::OpenMode::read);
  // A view of a foreign file may return any number of rows of any size.
  if (bag.integer(
          "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')") != 2)
    throw Error(ErrorCode::input,
                "the file has no tables 'topics' and 'messages', so it is no bag of rosbag2", file.string(),
                "check the path; ROS 1 bags are converted by `rosbags-convert`");
  std::map<std::int64_t, BagTopic> topics;
  auto rows = bag.prepare("SELECT id, name, type, serialization_format FROM topics");
  while (rows.step()) {
    if (rows.text(3) != "cdr")
      throw Error(ErrorCode::input, fmt::format("topic {} is serialized as '{}'", rows.text(1), rows.text(3)),
                  file.string(), "only CDR is read; convert it with `ros2 bag convert`");
    topics[rows.integer(0)] = {std::string(rows.text(1)), std::string(rows.text(2))};
  }
  std::uintmax_t left = std::filesystem::file_size(file);
  auto messages = bag.prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY rowid");
  while (messages.step()) {
    const auto bytes = messages.blob(2);
    if (bytes.size() > left)
      throw Error(ErrorCode::input, "the messages are larger than the file", file.string(),
                  "the bag is damaged; record or copy it again");
    left -= bytes.size();
    const auto topic = topics.find(messages.integer(0));
    if (topic == topics.end())
      throw Error(ErrorCode::input, fmt::format("a message has the unknown topic {}", messages.integer(0)),
                  file.string(), "the bag is damaged; record or copy it again");
    visit({.topic = topic->second.name,
           .type = topic->second.type,
           .received = messages.integer(1),
           .bytes = {reinterpret_cast<const char*>(bytes.data()), bytes.size()}});
  }
}

}  // namespace waymark::importers
