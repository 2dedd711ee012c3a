// SPDX-License-Identifier: Apache-2.0
#include <cpl_compressor.h>
#include <cpl_conv.h>
#include <gmock/gmock.h>
#include <lz4frame.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
#include "tests/importers/made_bag.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class Bag : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directory(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file(const std::string& name) const { return folder_ / name; }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }
  RobotLog read_rosbag2(const MadeBag& bag) const {
    write_rosbag2(file("made.db3"), bag);
    return importers::import_log(file("made.db3"), {});
  }
  static std::string refusal(const fs::path& path) {
    return message_of([&] { importers::import_log(path, {}); });
  }
  fs::path folder_ = fs::temp_directory_path() / ("waymark_bag_" + std::to_string(getpid()));
};

struct MadeDrive {
  MadeBag bag;
  std::string native;  // the same drive in Waymark's own format
};

// An arc with a scan at each pose, by a scanner that is mounted through two frames.
MadeDrive made_drive(bool big) {
  MadeDrive drive{.bag = {made_frame(big, "base_link", "mast", 0.5, 0, std::numbers::pi / 2),
                          made_frame(big, "mast", "laser", 0.2, 0, 0)},
                  .native = {}};
  Pose2 last;
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const double t = 100 + 0.25 * i;
    const Pose2 pose{3 * std::sin(0.1 * i), 3 - 3 * std::cos(0.1 * i), 0.1 * i};
    std::vector<float> ranges;
    for (int beam = 0; beam < 5; ++beam) ranges.push_back(1 + float(random() % 1000) / 128);
    drive.bag.push_back(made_odometry(big, t, pose.x, pose.y, pose.yaw));
    drive.bag.push_back(made_scan(big, t, -0.5, 0.25, ranges));
    std::ostringstream line;
    line.precision(17);
    const Pose2 step = inverse(last) * pose;
    if (i > 0)
      line << R"({"kind":"step","t":)" << t << R"(,"dx":)" << step.x << R"(,"dy":)" << step.y << R"(,"dyaw":)"
           << step.yaw << "}\n";
    line << R"({"kind":"laser","t":)" << t
         << R"(,"first_angle":-0.5,"angle_step":0.25,"most_range":30,"mount":{"x":0.5,"y":0.2,"yaw":)"
         << std::numbers::pi / 2 << R"(},"ranges":[)";
    for (std::size_t k = 0; k < ranges.size(); ++k) line << (k ? "," : "") << ranges[k];
    drive.native += line.str() + "]}\n";
    last = pose;
  }
  return drive;
}

void expect_same(const RobotLog& a, const RobotLog& b) {
  constexpr double kRounding = 1e-12;  // of quaternions and two chained transforms
  const auto near = [](const Pose2& p, const Pose2& q) {
    EXPECT_NEAR(p.x, q.x, kRounding);
    EXPECT_NEAR(p.y, q.y, kRounding);
    EXPECT_NEAR(p.yaw, q.yaw, kRounding);
  };
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].t, b.events[i].t);
    ASSERT_EQ(a.events[i].what.index(), b.events[i].what.index()) << "event " << i;
    if (const auto* step = std::get_if<StepReading>(&a.events[i].what))
      near(step->step, std::get<StepReading>(b.events[i].what).step);
    if (const auto* scan = std::get_if<LaserScan>(&a.events[i].what)) {
      const auto& other = std::get<LaserScan>(b.events[i].what);
      near(scan->robot_from_sensor, other.robot_from_sensor);
      EXPECT_EQ(scan->ranges, other.ranges);
      EXPECT_EQ(scan->first_angle, other.first_angle);
      EXPECT_EQ(scan->angle_step, other.angle_step);
      EXPECT_EQ(scan->max_range, other.max_range);
    }
  }
}

TEST_F(Bag, HoldsTheDriveOfAWaymarkLogInEitherByteOrderAndStorage) {
  for (const bool big : {false, true}) {
    const MadeDrive drive = made_drive(big);
    const RobotLog native = importers::import_log(write("made.jsonl", drive.native), {});
    ASSERT_EQ(native.events.size(), 99u);
    expect_same(read_rosbag2(drive.bag), native);
    for (const std::size_t chunk : {0u, 1u, 7u})
      expect_same(importers::import_log(write("made.mcap", made_mcap(drive.bag, chunk)), {}), native);
  }
}

std::string packed_by_gdal(const char* name, const std::string& content) {
  const CPLCompressor* codec = CPLGetCompressor(name);
  void* out = nullptr;
  std::size_t size = 0;
  EXPECT_TRUE(codec->pfnFunc(content.data(), content.size(), &out, &size, nullptr, codec->user_data));
  const std::string packed(static_cast<const char*>(out), size);
  CPLFree(out);
  return packed;
}

/// Returns a frame of LZ4 as the library writes it: small blocks with checksums, which need the blocks
/// before them.
std::string lz4_frame(const std::string& content) {
  LZ4F_preferences_t how{};
  how.frameInfo.blockSizeID = LZ4F_max64KB;
  how.frameInfo.blockMode = LZ4F_blockLinked;
  how.frameInfo.blockChecksumFlag = LZ4F_blockChecksumEnabled;
  how.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  how.frameInfo.contentSize = content.size();
  std::string frame(LZ4F_compressFrameBound(content.size(), &how), '\0');
  frame.resize(LZ4F_compressFrame(frame.data(), frame.size(), content.data(), content.size(), &how));
  return frame;
}

/// Returns a frame of LZ4 with one block that is not compressed, without checksums.
std::string stored_lz4_frame(const std::string& content) {
  const auto size = static_cast<std::uint32_t>(content.size());
  std::string frame("\x04\x22\x4D\x18\x40\x70\xDF", 7);
  for (int byte = 0; byte < 4; ++byte) frame += static_cast<char>((size | 0x80000000u) >> (8 * byte));
  return frame + content + std::string(4, '\0');
}

TEST_F(Bag, ReadsCompressedChunks) {
  if (CPLGetCompressor("zstd") == nullptr) GTEST_SKIP() << "this GDAL does not compress by zstd";
  const MadeDrive drive = made_drive(false);
  const RobotLog native = importers::import_log(write("made.jsonl", drive.native), {});
  const auto zstd = [](const std::string& all) { return packed_by_gdal("zstd", all); };
  const auto lz4 = [](const std::string& all) {
    const std::size_t half = all.size() / 2;
    return stored_lz4_frame(all.substr(0, half)) + lz4_frame(all.substr(half));
  };
  for (const std::size_t chunk : {1u, 70u}) {
    expect_same(importers::import_log(write("a.mcap", made_mcap(drive.bag, chunk, "zstd", zstd)), {}),
                native);
    expect_same(importers::import_log(write("a.mcap", made_mcap(drive.bag, chunk, "lz4", lz4)), {}), native);
  }
  // Any damage is an error or a shorter drive, never a crash.
  std::mt19937 random(3);
  const std::string whole = made_mcap(drive.bag, 70, "lz4", lz4);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[50 + random() % (damaged.size() - 50)] = static_cast<char>(random());
    try {
      importers::import_log(write("b.mcap", damaged), {});
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("b.mcap"));
    }
  }
}

TEST_F(Bag, OfSeveralFilesIsOneDrive) {
  const MadeDrive drive = made_drive(false);
  const auto middle = drive.bag.begin() + 41;
  fs::create_directory(file("drive"));
  write_rosbag2(file("drive/drive_0.db3"), {drive.bag.begin(), middle});
  write_rosbag2(file("drive/drive_1.db3"), {middle, drive.bag.end()});
  expect_same(importers::import_log(file("drive"), {}),
              importers::import_log(write("made.jsonl", drive.native), {}));
}

TEST_F(Bag, ScansOfAScannerUpsideDownAreTurnedOver) {
  const RobotLog log = read_rosbag2({made_frame(false, "base_link", "laser", 1, 2, 0.5, true),
                                     made_scan(false, 1, -0.5, 0.25, {1, 2, 3, 4}, "/scan", {5, 6, 7, 8})});
  ASSERT_EQ(log.events.size(), 1u);
  const auto& scan = std::get<LaserScan>(log.events[0].what);
  EXPECT_NEAR(scan.robot_from_sensor.yaw, 0.5, 1e-12);
  EXPECT_EQ(scan.first_angle, -0.25);  // the last beam was at +0.25 and is now the first, to the right
  EXPECT_EQ(scan.ranges, (std::vector<float>{4, 3, 2, 1}));
  EXPECT_EQ(scan.intensities, (std::vector<float>{8, 7, 6, 5}));
}

TEST_F(Bag, ReadsTheTopicWithTheMostMessagesAndNamesTheOthers) {
  const RobotLog log =
      read_rosbag2({made_odometry(false, 1, 0, 0, 0, "/wheel"), made_odometry(false, 1, 0, 0, 0),
                    made_odometry(false, 2, 1, 0, 0), made_odometry(false, 2, 9, 0, 0)});
  EXPECT_THAT(
      log.remarks,
      Contains(HasSubstr("odometry is read from /odom, which has the most messages; not from /wheel")));
  ASSERT_EQ(log.events.size(), 2u);
  EXPECT_EQ(std::get<StepReading>(log.events[0].what).step.x, 1);
}

TEST_F(Bag, ReadsTheTopicsThatAreAskedFor) {
  write_rosbag2(file("made.db3"),
                {made_odometry(false, 1, 0, 0, 0, "/wheel"), made_odometry(false, 2, 7, 0, 0, "/wheel"),
                 made_odometry(false, 1, 0, 0, 0), made_odometry(false, 2, 1, 0, 0),
                 made_odometry(false, 3, 9, 0, 0), made_scan(false, 1, 0, 0.1, {3, 2})});
  const auto read = [&](std::vector<std::string> topics) {
    return importers::import_log(file("made.db3"), {}, {.topics = std::move(topics)});
  };
  const RobotLog log = read({"/wheel"});
  EXPECT_THAT(log.remarks, Contains(HasSubstr("odometry is read from /wheel, as asked; not from /odom")));
  ASSERT_EQ(log.events.size(), 2u);  // the scan, too
  EXPECT_EQ(std::get<StepReading>(log.events[1].what).step.x, 7);
  EXPECT_THAT(message_of([&] { read({"/rear"}); }), HasSubstr("it has them of /odom, /wheel, /scan"));
  EXPECT_THAT(message_of([&] { read({"/odom", "/wheel"}); }), HasSubstr("name one topic of odometry"));
  const auto native = [&] { importers::import_log(write("a.jsonl", ""), {}, {.topics = {"/scan"}}); };
  EXPECT_THAT(message_of(native), HasSubstr("only bags of ROS 2"));
}

TEST_F(Bag, PosesAndTransformsInAFrameOfOdometryAreOdometryIfThereIsNoOther) {
  const auto steps = [](const RobotLog& log) {
    std::vector<double> all;
    for (const LogEvent& event : log.events)
      if (const auto* step = std::get_if<StepReading>(&event.what)) all.push_back(step->step.x);
    return all;
  };
  const auto moves = [](double t, double x, const std::string& parent, const std::string& child) {
    MadeMessage frame{
        "/tf", "tf2_msgs/msg/TFMessage",
        MadeCdr(false).add(std::uint32_t{1}).header(t, parent).text(child).pose(x, 0, 0, 0).bytes()};
    return frame;
  };
  const MadeBag transforms{moves(1, 0, "odom", "base_footprint"), moves(2, 3, "odom", "base_footprint"),
                           moves(3, 7, "odom", "base_footprint"), moves(1, 0, "map", "odom"),
                           moves(2, 50, "map", "odom"),           moves(3, 90, "map", "odom")};
  const RobotLog moved = read_rosbag2(transforms);
  EXPECT_EQ(steps(moved), (std::vector<double>{3, 4}));
  EXPECT_THAT(moved.remarks,
              Contains(HasSubstr("3 transforms of /tf (odom to base_footprint) are taken for it")));

  MadeBag poses = transforms;
  for (const bool has_covariance : {true, false})
    for (const int i : {0, 1}) {
      poses.push_back(made_pose(false, 1 + i, 5 * i, 0, 0, has_covariance ? "/ekf" : "/plain",
                                "robot1/odom_combined", has_covariance));
      poses.push_back(made_pose(false, 1 + i, 40 * i, 0, 0, "/amcl_pose", "map"));
    }
  const RobotLog posed = read_rosbag2(poses);
  EXPECT_EQ(steps(posed), (std::vector<double>{5}));
  EXPECT_THAT(posed.remarks,
              Contains(HasSubstr("2 poses of /ekf in the frame robot1/odom_combined are taken as")));
  EXPECT_THAT(
      posed.remarks,
      Contains(HasSubstr("4 messages of type geometry_msgs/msg/PoseWithCovarianceStamped of /amcl_pose "
                         "are skipped")));
  write_rosbag2(file("asked.db3"), poses);
  EXPECT_EQ(steps(importers::import_log(file("asked.db3"), {}, {.topics = {"/plain"}})),
            (std::vector<double>{5}));
  EXPECT_THAT(steps(importers::import_log(file("asked.db3"), {}, {.topics = {"/amcl_pose"}})), Contains(40));

  poses.push_back(made_odometry(false, 1, 0, 0, 0)), poses.push_back(made_odometry(false, 2, 9, 0, 0));
  const RobotLog both = read_rosbag2(poses);
  EXPECT_EQ(steps(both), (std::vector<double>{9}));
  EXPECT_THAT(both.remarks, Contains(HasSubstr("of /ekf are skipped")));
}

TEST_F(Bag, RangesBelowTheMinimumAndWithoutReturnAreNone) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const RobotLog log = read_rosbag2({made_scan(false, 1, 0, 0.1, {0.05f, none, 2})});
  EXPECT_EQ(std::get<LaserScan>(log.events[0].what).ranges, (std::vector<float>{0, 0, 2}));
  EXPECT_THAT(log.remarks, Contains(HasSubstr("no transform leads from laser to base_link")));
}

TEST_F(Bag, UnstampedMessagesHaveTheTimeOfTheRecorder) {
  MadeMessage scan = made_scan(false, 0, 0, 0.1, {1, 2});
  scan.received = 7'500'000'000;
  EXPECT_EQ(read_rosbag2({scan}).events[0].t, 7.5);
}

TEST_F(Bag, BadMessagesAreSkippedAndCounted) {
  MadeBag bag = made_drive(false).bag;
  bag.push_back({"/odom", "nav_msgs/msg/Odometry", "\x02"});
  bag.push_back({"/odom", "nav_msgs/msg/Odometry", std::string("\0\3\0\0", 4)});
  bag.push_back({"/odom", "nav_msgs/msg/Odometry", bag[2].bytes.substr(0, 60)});
  bag.push_back({"/camera", "sensor_msgs/msg/Image", ""});
  const RobotLog log = read_rosbag2(bag);
  EXPECT_EQ(log.events.size(), 99u);
  EXPECT_THAT(log.remarks,
              Contains(HasSubstr("3 messages cannot be read and are skipped, the first is of topic "
                                 "/odom: the message ends too early")));
  EXPECT_THAT(log.remarks,
              Contains(HasSubstr("1 messages of type sensor_msgs/msg/Image of /camera are skipped")));
}

TEST_F(Bag, RefusalsSayWhatToDo) {
  EXPECT_THAT(refusal(write("a.mcap", "nothing")), HasSubstr("does not begin like an MCAP file"));
  EXPECT_THAT(refusal(write("a.mcap", made_mcap({}, 0))), HasSubstr("neither odometry nor scans"));
  const MadeBag& bag = made_drive(false).bag;
  EXPECT_THAT(refusal(write("a.mcap", made_mcap(bag, 7, "bz2"))), HasSubstr("compressed by 'bz2'"));
  EXPECT_THAT(refusal(write("a.mcap", made_mcap(bag, 7, "zstd"))), HasSubstr("cannot be decompressed"));
  EXPECT_THAT(refusal(write("a.mcap", made_mcap(bag, 7, "lz4"))), HasSubstr("no frame"));
  write_rosbag2(file("empty.db3"), {});
  EXPECT_THAT(refusal(file("empty.db3")), HasSubstr("neither odometry nor scans"));
  write_rosbag2(file("tilted.db3"), {made_scan(false, 1, 0, 0.1, {1, 2}),
                                     {"/tf", "tf2_msgs/msg/TFMessage",
                                      MadeCdr(false)
                                          .add(std::uint32_t{1})
                                          .header(0, "base_link")
                                          .text("laser")
                                          .add(0.0)
                                          .add(0.0)
                                          .add(0.0)
                                          .add(0.6)
                                          .add(0.0)
                                          .add(0.0)
                                          .add(0.8)
                                          .bytes()}});
  EXPECT_THAT(refusal(file("tilted.db3")), HasSubstr("the scanner laser is tilted by 74 degrees"));
}

TEST_F(Bag, WithAViewInPlaceOfATableIsRefused) {
  sqlite3* db = nullptr;
  sqlite3_open(file("view.db3").c_str(), &db);
  sqlite3_exec(db,
               "CREATE TABLE topics(id, name, type, serialization_format);"
               "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)"
               " SELECT i AS id, 1 AS topic_id, 0 AS timestamp, zeroblob(1000000) AS data FROM n",
               nullptr, nullptr, nullptr);
  sqlite3_close(db);
  EXPECT_THAT(refusal(file("view.db3")), HasSubstr("no tables 'topics' and 'messages'"));
}

TEST_F(Bag, CutOffMcapIsReadUpToThere) {
  const std::string whole = made_mcap(made_drive(false).bag, 1);
  const RobotLog log = importers::import_log(write("cut.mcap", whole.substr(0, whole.size() / 2)), {});
  EXPECT_GT(log.events.size(), 20u);
  EXPECT_LT(log.events.size(), 99u);
  EXPECT_THAT(log.remarks, Contains(HasSubstr("cut.mcap is cut off after byte")));
}

// A crash or an allocation beyond the file's size ends the test program.
TEST_F(Bag, MutatedFilesAreReadOrRefused) {
  const MadeBag bag = made_drive(true).bag;
  write_rosbag2(file("whole.db3"), bag);
  const std::string database = read_text(file("whole.db3"), "the bag");
  int refused = 0, read = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    const bool mcap = seed % 2 == 0;
    const std::string bytes = mutated_bag(bag, database, seed);
    try {
      importers::import_log(write(mcap ? "m.mcap" : "m.db3", bytes), {});
      ++read;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace waymark::test
