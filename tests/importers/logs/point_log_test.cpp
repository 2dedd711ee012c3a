// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/point_files.hpp"
#include "localization/robot_log.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace importers;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PointLog : public testing::Test {
 protected:
  PointLog() : folder_(fs::path(testing::TempDir()) / ("points_" + std::to_string(getpid()))) {
    fs::create_directories(folder_ / "velodyne");
    register_landmark_types(types_);
  }
  ~PointLog() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  static std::string refusal(const std::function<void()>& call) {
    return message_of([&] { call(); });
  }

  fs::path folder_;
  TypeRegistry types_;
};

std::string floats(std::initializer_list<float> values, bool swap = false) {
  std::string bytes;
  for (const float value : values) {
    char raw[4];
    std::memcpy(raw, &value, 4);
    if (swap) std::swap(raw[0], raw[3]), std::swap(raw[1], raw[2]);
    bytes.append(raw, 4);
  }
  return bytes;
}

/// A pole of 3 m and 0.2 m wide at (8, 6) on the ground 1.7 m below the scanner, and what is seen of it.
std::string kitti_scan() {
  std::string bytes;
  for (float x = -20; x < 20; x += 0.25F)
    for (float y = -20; y < 20; y += 0.25F) bytes += floats({x, y, -1.7F, 0});
  for (float z = -1.7F; z < 1.3F; z += 0.1F)
    for (float turn = -1.2F; turn <= 1.21F; turn += 0.3F) {
      const float facing = std::atan2(-6.0F, -8.0F) + turn;
      bytes += floats({8 + 0.1F * std::cos(facing), 6 + 0.1F * std::sin(facing), z, 0});
    }
  return bytes;
}

TEST_F(PointLog, ScansOfAFolderBecomeSightings) {
  write("velodyne/000001.bin", kitti_scan());
  write("velodyne/000000.bin", floats({1, 2, 3, 0}));
  write("times.txt", "5.0\n5.5\n");
  const localization::RobotLog log = import_log(folder_, types_);
  ASSERT_EQ(log.events.size(), 2U);
  EXPECT_EQ(log.events[1].t, 5.5);
  const auto& seen = std::get<localization::SightingSet>(log.events[1].what);
  ASSERT_EQ(seen.sightings.size(), 1U);
  EXPECT_NEAR(*seen.sightings[0].range, 10, 0.03);
  EXPECT_NEAR(*seen.sightings[0].bearing, std::atan2(6, 8), 0.01);
}

TEST_F(PointLog, ARecordNamesAFileBesideTheLog) {
  write("one.bin", kitti_scan());
  const fs::path log_file =
      write("drive.jsonl", R"({"kind":"points","t":1,"file":"one.bin","mount":{"x":1,"y":0}})");
  const localization::RobotLog log = import_log(log_file, types_);
  ASSERT_EQ(log.events.size(), 1U);
  const auto& seen = std::get<localization::SightingSet>(log.events[0].what);
  EXPECT_EQ(seen.sightings.size(), 1U);
  EXPECT_EQ(seen.robot_from_sensor.x, 1);
}

TEST_F(PointLog, PlyOfAllEncodingsGivesTheSamePoints) {
  const std::string head =
      "element vertex 2\nproperty float x\nproperty uchar intensity\nproperty float y\n"
      "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
  const auto ascii = write("a.ply", "ply\nformat ascii 1.0\n" + head + "1 7 2 3\n-4 8 nan 6\n");
  const std::string red(1, 'r');
  const auto little = write("l.ply", "ply\nformat binary_little_endian 1.0\n" + head + floats({1}) + red +
                                         floats({2, 3}) + floats({4}) + red + floats({5, 6}));
  const auto big = write("b.ply", "ply\nformat binary_big_endian 1.0\n" + head + floats({1}, true) + red +
                                      floats({2, 3}, true) + floats({4}, true) + red + floats({5, 6}, true));
  EXPECT_THAT(read_point_file(ascii).points, testing::ElementsAre(Eigen::Vector3f(1, 2, 3)));
  EXPECT_THAT(read_point_file(little).points,
              testing::ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(4, 5, 6)));
  EXPECT_EQ(read_point_file(little).points, read_point_file(big).points);
  EXPECT_THAT(read_point_file(ascii).intensities, testing::ElementsAre(7))
      << "the second point is not finite";
  EXPECT_THAT(read_point_file(little).intensities, testing::ElementsAre('r', 'r'));
  EXPECT_EQ(read_point_file(little).intensities, read_point_file(big).intensities);
}

TEST_F(PointLog, KittiScansHaveIntensities) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto scan = read_point_file(write("a.bin", floats({1, 2, 3, 0.25F, nan, 0, 0, 9, 4, 5, 6, 0.5F})));
  EXPECT_THAT(scan.points, testing::ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(4, 5, 6)));
  EXPECT_THAT(scan.intensities, testing::ElementsAre(0.25F, 0.5F));
  EXPECT_TRUE(read_point_file(write("b.bin", floats({1, 2, 3, 0}))).intensities.empty()) << "none written";
}

TEST_F(PointLog, FaultsAreNamed) {
  const auto reads = [&](const fs::path& file) { return refusal([&] { read_point_file(file); }); };
  EXPECT_THAT(reads(write("cut.bin", floats({1, 2, 3}))),
              HasSubstr("12 bytes are no whole number of points"));
  EXPECT_THAT(reads(write("far.bin", floats({1e6F, 0, 0, 0}))), HasSubstr("no metres from a scanner"));
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n";
  EXPECT_THAT(reads(write("z.ply", head + "end_header\n1 2\n3 4\n")), HasSubstr("lack x, y or z"));
  EXPECT_THAT(reads(write("s.ply", head + "property float z\nend_header\n1 2 3\n")),
              HasSubstr("after 1 of 2"));
  EXPECT_THAT(reads(write("h.ply", head)), HasSubstr("does not end"));
  EXPECT_THAT(reads(write("w.pcd", "VERSION .7")), HasSubstr("neither a KITTI scan"));
  write("velodyne/0.bin", floats({1, 2, 3, 0}));
  write("times.txt", "1 2 3");
  EXPECT_THAT(refusal([&] { import_log(folder_, types_); }), HasSubstr("3 times for 1 scans"));
  fs::remove_all(folder_ / "velodyne");
  fs::create_directories(folder_ / "empty");
  EXPECT_THAT(refusal([&] { import_point_log(folder_ / "empty", types_); }), HasSubstr("no 3-D scans"));
}

}  // namespace
}  // namespace waymark::test
