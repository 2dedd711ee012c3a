// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace waymark::test {

/// Writes messages in CDR, in either byte order.
class MadeCdr {
 public:
  explicit MadeCdr(bool big) : big_(big), bytes_(big ? "\0\0\0\0" : "\0\1\0\0", 4) {}

  template <class T>
  MadeCdr& add(T value) {
    while ((bytes_.size() - 4) % sizeof(T)) bytes_ += '\0';
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_) std::reverse(raw, raw + sizeof(T));
    bytes_.append(raw, sizeof(T));
    return *this;
  }
  MadeCdr& text(const std::string& value) {
    add(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value + '\0';
    return *this;
  }
  MadeCdr& header(double t, const std::string& frame) {
    const double seconds = std::floor(t);
    return add(static_cast<std::int32_t>(seconds))
        .add(static_cast<std::uint32_t>(std::lround((t - seconds) * 1e9)))
        .text(frame);
  }
  /// Turn about z by `yaw`, after a half turn about x if `over`.
  MadeCdr& pose(double x, double y, double z, double yaw, bool over = false) {
    add(x).add(y).add(z);
    const double c = std::cos(yaw / 2), s = std::sin(yaw / 2);
    return over ? add(c).add(s).add(0.0).add(0.0) : add(0.0).add(0.0).add(s).add(c);
  }
  std::string bytes() const { return bytes_; }

 private:
  bool big_;
  std::string bytes_;
};

struct MadeMessage {
  std::string topic, type, bytes;
  std::int64_t received = 0;
};
using MadeBag = std::vector<MadeMessage>;

inline MadeMessage made_odometry(bool big, double t, double x, double y, double yaw,
                                 const std::string& topic = "/odom") {
  MadeCdr cdr(big);
  cdr.header(t, "odom").text("base_link").pose(x, y, 0, yaw);
  for (int i = 0; i < 36 + 6 + 36; ++i) cdr.add(0.0);
  return {topic, "nav_msgs/msg/Odometry", cdr.bytes()};
}

/// A pose in a frame: geometry_msgs/msg/PoseWithCovarianceStamped, or PoseStamped.
inline MadeMessage made_pose(bool big, double t, double x, double y, double yaw, const std::string& topic,
                             const std::string& frame, bool has_covariance = true) {
  MadeCdr cdr(big);
  cdr.header(t, frame).pose(x, y, 0, yaw);
  for (int i = 0; has_covariance && i < 36; ++i) cdr.add(0.0);
  return {topic,
          has_covariance ? "geometry_msgs/msg/PoseWithCovarianceStamped" : "geometry_msgs/msg/PoseStamped",
          cdr.bytes()};
}

inline MadeMessage made_scan(bool big, double t, double first, double step, const std::vector<float>& ranges,
                             const std::string& topic = "/scan", const std::vector<float>& intensities = {}) {
  MadeCdr cdr(big);
  cdr.header(t, "laser").add(float(first)).add(float(first + step * double(ranges.size() - 1)));
  cdr.add(float(step)).add(0.f).add(0.f).add(0.1f).add(30.f).add(static_cast<std::uint32_t>(ranges.size()));
  for (const float r : ranges) cdr.add(r);
  cdr.add(static_cast<std::uint32_t>(intensities.size()));
  for (const float intensity : intensities) cdr.add(intensity);
  return {topic, "sensor_msgs/msg/LaserScan", cdr.bytes()};
}

/// `covariance` is the first element of the 3 x 3 matrix of the orientation or the rate; its last is the
/// variance of the yaw or of the rate about z.
struct MadeImu {
  double orientation_first = -1, yaw = 0, yaw_variance = 0;
  double rate_first = 0, rate = 0, rate_variance = 0;
  bool over =
      false;  ///< the sensor hangs upside down: `yaw` and `rate` are about the z axis that points down
  std::string topic = "/imu";
};
inline MadeMessage made_imu(bool big, double t, const MadeImu& imu) {
  MadeCdr cdr(big);
  cdr.header(t, "imu");
  if (imu.over)
    cdr.add(std::cos(imu.yaw / 2)).add(std::sin(imu.yaw / 2)).add(0.0).add(0.0);
  else
    cdr.add(0.0).add(0.0).add(std::sin(imu.yaw / 2)).add(std::cos(imu.yaw / 2));
  const auto covariance = [&](double first, double last) {
    cdr.add(first);
    for (int i = 1; i < 8; ++i) cdr.add(0.0);
    cdr.add(last);
  };
  covariance(imu.orientation_first, imu.yaw_variance);
  cdr.add(0.0).add(0.0).add(imu.rate);
  covariance(imu.rate_first, imu.rate_variance);
  for (int i = 0; i < 3 + 9; ++i) cdr.add(0.0);
  return {imu.topic, "sensor_msgs/msg/Imu", cdr.bytes()};
}

struct MadeFix {
  int status = 0;
  double latitude = 48, longitude = 11;
  double east = 4, east_north = 0, north = 4;  ///< covariance, m^2
  int covariance_type = 3;
};
inline MadeMessage made_fix(bool big, double t, const MadeFix& fix) {
  MadeCdr cdr(big);
  cdr.header(t, "gps").add(static_cast<std::int8_t>(fix.status)).add(std::uint16_t{1});
  cdr.add(fix.latitude).add(fix.longitude).add(500.0);
  for (const double v : {fix.east, fix.east_north, 0.0, fix.east_north, fix.north, 0.0, 0.0, 0.0, 9.0})
    cdr.add(v);
  cdr.add(static_cast<std::uint8_t>(fix.covariance_type));
  return {"/fix", "sensor_msgs/msg/NavSatFix", cdr.bytes()};
}

struct MadeField {
  std::string name;
  std::uint32_t offset = 0;
  int type = 7;  ///< 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
};
/// Layout of a point cloud.
struct MadeCloud {
  std::vector<MadeField> fields{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
  std::uint32_t point_step = 12, rows = 1;
  std::uint32_t row_padding = 0;
  bool big_data = false;  ///< numbers of the points are big-endian, whatever the order of the message
  std::string topic = "/points";
  std::string frame = "scanner";
};
inline MadeMessage made_cloud(bool big, double t, const std::vector<std::array<double, 3>>& points,
                              const MadeCloud& cloud = {}) {
  const auto columns = static_cast<std::uint32_t>(points.size()) / cloud.rows;
  const std::uint32_t row_step = columns * cloud.point_step + cloud.row_padding;
  std::string data(std::size_t{row_step} * cloud.rows, '\xee');
  for (std::uint32_t i = 0; i < columns * cloud.rows; ++i)
    for (const MadeField& field : cloud.fields) {
      const std::size_t at =
          std::size_t{i / columns} * row_step + std::size_t{i % columns} * cloud.point_step + field.offset;
      const auto put = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (cloud.big_data) std::reverse(raw, raw + sizeof value);
        std::memcpy(data.data() + at, raw, sizeof value);
      };
      const double value = field.name == "x"   ? points[i][0]
                           : field.name == "y" ? points[i][1]
                           : field.name == "z" ? points[i][2]
                                               : 77;
      switch (field.type) {
        case 1:
          put(static_cast<std::int8_t>(value));
          break;
        case 2:
          put(static_cast<std::uint8_t>(value));
          break;
        case 3:
          put(static_cast<std::int16_t>(value));
          break;
        case 4:
          put(static_cast<std::uint16_t>(value));
          break;
        case 5:
          put(static_cast<std::int32_t>(value));
          break;
        case 6:
          put(static_cast<std::uint32_t>(value));
          break;
        case 7:
          put(static_cast<float>(value));
          break;
        default:
          put(value);
      }
    }
  MadeCdr cdr(big);
  cdr.header(t, cloud.frame)
      .add(cloud.rows)
      .add(columns)
      .add(static_cast<std::uint32_t>(cloud.fields.size()));
  for (const MadeField& field : cloud.fields)
    cdr.text(field.name).add(field.offset).add(static_cast<std::uint8_t>(field.type)).add(std::uint32_t{1});
  cdr.add(static_cast<std::uint8_t>(cloud.big_data)).add(cloud.point_step).add(row_step);
  cdr.add(static_cast<std::uint32_t>(data.size()));
  for (const char c : data) cdr.add(c);
  cdr.add(std::uint8_t{0});
  return {cloud.topic, "sensor_msgs/msg/PointCloud2", cdr.bytes()};
}

inline MadeMessage made_frame(bool big, const std::string& parent, const std::string& child, double x,
                              double y, double yaw, bool over = false) {
  MadeCdr cdr(big);
  cdr.add(std::uint32_t{1}).header(0, parent).text(child).pose(x, y, 0.3, yaw, over);
  return {"/tf_static", "tf2_msgs/msg/TFMessage", cdr.bytes()};
}

inline void write_rosbag2(const std::filesystem::path& file, const MadeBag& bag) {
  std::filesystem::remove(file);
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  sqlite3_exec(
      db,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT "
      "NULL, data BLOB NOT NULL); BEGIN",
      nullptr, nullptr, nullptr);
  std::map<std::string, int> topics;
  for (const MadeMessage& m : bag) {
    sqlite3_stmt* statement = nullptr;
    if (topics.try_emplace(m.topic, int(topics.size()) + 1).second) {
      sqlite3_prepare_v2(db, "INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", -1, &statement, nullptr);
      sqlite3_bind_int(statement, 1, topics[m.topic]);
      sqlite3_bind_text(statement, 2, m.topic.c_str(), -1, SQLITE_TRANSIENT);
      sqlite3_bind_text(statement, 3, m.type.c_str(), -1, SQLITE_TRANSIENT);
      sqlite3_step(statement);
      sqlite3_finalize(statement);
    }
    sqlite3_prepare_v2(db, "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", -1, &statement,
                       nullptr);
    sqlite3_bind_int(statement, 1, topics[m.topic]);
    sqlite3_bind_int64(statement, 2, m.received);
    sqlite3_bind_blob(statement, 3, m.bytes.data(), int(m.bytes.size()), SQLITE_TRANSIENT);
    sqlite3_step(statement);
    sqlite3_finalize(statement);
  }
  sqlite3_exec(db, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(db);
}

/// Bytes of an MCAP file; with `chunk_size` > 0, so many messages share a chunk with their channels. `pack`
/// compresses a chunk.
inline std::string made_mcap(
    const MadeBag& bag, std::size_t chunk_size, const std::string& compression = "",
    const std::function<std::string(const std::string&)>& pack = [](const std::string& all) { return all; }) {
  const auto number = []<class T>(T value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto text = [&](const std::string& s) { return number(std::uint32_t(s.size())) + s; };
  const auto record = [&](int opcode, const std::string& content) {
    return char(opcode) + number(std::uint64_t(content.size())) + content;
  };
  std::string out = "\x89MCAP0\r\n" + record(1, text("ros2") + text("made")), chunk;
  std::map<std::string, std::uint16_t> channels;
  std::size_t in_chunk = 0;
  const auto close = [&] {
    if (chunk_size && !chunk.empty()) {
      const std::string packed = pack(chunk);
      out += record(6, number(std::uint64_t{0}) + number(std::uint64_t{0}) +
                           number(std::uint64_t(chunk.size())) + number(std::uint32_t{0}) +
                           text(compression) + number(std::uint64_t(packed.size())) + packed);
    } else {
      out += chunk;
    }
    chunk.clear(), in_chunk = 0;
  };
  for (const MadeMessage& m : bag) {
    if (channels.try_emplace(m.topic, std::uint16_t(channels.size() + 1)).second) {
      const auto id = number(channels[m.topic]);
      chunk += record(3, id + text(m.type) + text("ros2msg") + text("float64 x"));
      chunk += record(4, id + id + text(m.topic) + text("cdr") + number(std::uint32_t{0}));
    }
    chunk += record(5, number(channels[m.topic]) + number(std::uint32_t{0}) + number(m.received) +
                           number(m.received) + m.bytes);
    if (++in_chunk == chunk_size) close();
  }
  close();
  return out + record(15, number(std::uint32_t{0})) +
         record(2, number(std::uint64_t{0}) + number(std::uint64_t{0}) + number(std::uint32_t{0})) +
         "\x89MCAP0\r\n";
}

/// Returns a damaged copy of a bag, which is also given as a rosbag2 `database`: an MCAP file for even seeds,
/// a database for odd ones.
inline std::string mutated_bag(const MadeBag& bag, const std::string& database, unsigned seed) {
  std::mt19937 random(seed);
  std::string bytes = seed % 2 == 0 ? made_mcap(bag, seed % 3 * 5) : database;
  for (unsigned n = 0; n <= random() % 40; ++n)
    bytes[random() % bytes.size()] = char(random() % 3 ? random() : 255);
  if (random() % 4 == 0) bytes.resize(random() % bytes.size());
  return bytes;
}

}  // namespace waymark::test
