// SPDX-License-Identifier: Apache-2.0
// Satellite fixes, inertial readings and point clouds of bags.
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "geo/local_frame.hpp"
#include "importers/logs/bag_messages.hpp"
#include "importers/logs/gyro_yaw.hpp"
#include "importers/logs/import_log.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/robot_log.hpp"
#include "tests/importers/made_bag.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class BagSensors : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directory(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  /// Reads the bag from both kinds of files, which give the same number of events.
  RobotLog read(const MadeBag& bag, const importers::LogImport& how = {}) const {
    write_rosbag2(folder_ / "made.db3", bag);
    std::ofstream(folder_ / "made.mcap", std::ios::binary) << made_mcap(bag, 3);
    RobotLog log = importers::import_log(folder_ / "made.db3", types_, how);
    EXPECT_EQ(importers::import_log(folder_ / "made.mcap", types_, how).events.size(), log.events.size());
    return log;
  }
  template <class Reading>
  static std::vector<std::pair<double, Reading>> of_kind(const RobotLog& log) {
    std::vector<std::pair<double, Reading>> found;
    for (const LogEvent& e : log.events)
      if (const auto* reading = std::get_if<Reading>(&e.what)) found.emplace_back(e.t, *reading);
    return found;
  }

  fs::path folder_ = fs::temp_directory_path() / ("waymark_bag_sensors_" + std::to_string(getpid()));
  TypeRegistry types_ = [] {
    TypeRegistry types;
    register_landmark_types(types);
    return types;
  }();
};

TEST_F(BagSensors, SatelliteFixesHaveTheirCovarianceAndItsLargestDeviation) {
  for (const bool big : {false, true}) {
    const RobotLog log =
        read({made_fix(big, 1, {.east = 4, .north = 9, .covariance_type = 2}),
              // Eigenvalues of [[5, 4], [4, 5]] are 9 and 1; the type says that only 5, 5 count.
              made_fix(big, 2, {.east = 5, .east_north = 4, .north = 5, .covariance_type = 3}),
              made_fix(big, 3, {.east = 5, .east_north = 4, .north = 5, .covariance_type = 1}),
              made_fix(big, 4, {.covariance_type = 0})});
    const auto fixes = of_kind<GnssFix>(log);
    ASSERT_EQ(fixes.size(), 4u);
    EXPECT_DOUBLE_EQ(fixes[0].second.sd, 3);
    EXPECT_DOUBLE_EQ(fixes[1].second.sd, 3);
    EXPECT_DOUBLE_EQ(fixes[2].second.sd, std::sqrt(5));
    EXPECT_DOUBLE_EQ(fixes[3].second.sd, 3);
    EXPECT_EQ(fixes[0].second.noise(), (Eigen::Matrix2d() << 4, 0, 0, 9).finished());
    EXPECT_EQ(fixes[1].second.noise(), (Eigen::Matrix2d() << 5, 4, 4, 5).finished());
    EXPECT_EQ(fixes[2].second.noise(), (Eigen::Matrix2d() << 5, 0, 0, 5).finished());
    EXPECT_FALSE(fixes[3].second.covariance);
    EXPECT_EQ(fixes[0].second.at, Eigen::Vector2d(11, 48));
    EXPECT_EQ(log.fix_crs, "EPSG:4326");
    EXPECT_THAT(log.remarks,
                Contains(HasSubstr("4 satellite fixes are read from /fix; 1 state no covariance")));
  }
}

TEST_F(BagSensors, FixesThatAreNoneAreCountedAndNumbersThatAreNoneAreRefused) {
  const RobotLog log = read({made_fix(false, 1, {.status = -1, .latitude = kNone}), made_fix(false, 2, {}),
                             made_fix(false, 3, {.latitude = kNone}), made_fix(false, 4, {.latitude = 91}),
                             made_fix(false, 5, {.longitude = 1e9}), made_fix(false, 6, {.north = kNone}),
                             made_fix(false, 7, {.covariance_type = 4})});
  EXPECT_EQ(of_kind<GnssFix>(log).size(), 1u);
  EXPECT_THAT(log.remarks, Contains(HasSubstr("1 messages of /fix are without a satellite fix")));
  EXPECT_THAT(log.remarks,
              Contains(HasSubstr("5 messages cannot be read and are skipped, the first is of topic "
                                 "/fix: a position is no latitude and longitude")));
}

TEST_F(BagSensors, FixesLieInTheMapOfAnyCrsOfTheBody) {
  const RobotLog bag = read({made_fix(false, 1, {})});
  for (const char* crs : {"EPSG:4326", "EPSG:32632", "EPSG:32633"}) {
    const Crs map = Crs::from_text(crs);
    const auto at = [&](double x, double y) {
      const auto [east, north] = CrsTransform(Crs::from_text("EPSG:4326"), map)(x, y);
      return Point<MapCrs>{{east, north, 0}};
    };
    RobotLog log = bag;
    convert_to_map_frame(log, LocalFrame(map, at(11, 47.999)));
    const auto fixes = of_kind<GnssFix>(log);
    ASSERT_EQ(fixes.size(), 1u);
    EXPECT_NEAR(fixes[0].second.at.x(), 0, 1e-3) << crs;
    EXPECT_NEAR(fixes[0].second.at.y(), 111.2, 0.1) << crs;  // a thousandth of a degree of latitude
  }
  RobotLog local = bag, mars = bag;
  convert_to_map_frame(local, LocalFrame(Crs::local(), {}));
  EXPECT_TRUE(local.events.empty());
  EXPECT_THAT(local.remarks,
              Contains(HasSubstr("1 fixes are omitted: they are positions on Earth, and the map has a "
                                 "local CRS")));
  convert_to_map_frame(mars, LocalFrame(Crs::from_text("IAU_2015:49900"), {}));
  EXPECT_TRUE(mars.events.empty());
}

TEST_F(BagSensors, TheArmOfTheAntennaIsAnError) {
  const RobotLog log =
      read({made_frame(false, "base_link", "gps", 0.3, 0.4, 0), made_fix(false, 1, {.east = 1, .north = 1})});
  EXPECT_NEAR(of_kind<GnssFix>(log).at(0).second.sd, std::sqrt(1.25), 1e-12);
}

/// Odometry along x that never turns, as of a vehicle without a gyro that drives an arc at 1 m/s and 0.2
/// rad/s.
MadeBag arc_without_yaw(bool big, double imu_sign, bool over) {
  MadeBag bag{made_frame(big, "base_link", "imu", 0, 0, 0, over)};
  for (int i = 0; i <= 100; ++i) {
    const double t = 10 + 0.1 * i;
    bag.push_back(made_odometry(big, t, 0.1 * i, 0, 0));
    bag.push_back(made_imu(big, t, {.rate = 0.2 * imu_sign, .rate_variance = 1e-4}));
  }
  return bag;
}

TEST_F(BagSensors, AGyroGivesTheYawThatOdometryLacks) {
  for (const bool over : {false, true}) {
    const RobotLog log = read(arc_without_yaw(over, over ? -1 : 1, over));
    const auto steps = of_kind<StepReading>(log);
    ASSERT_EQ(steps.size(), 100u);
    Pose2 pose;
    for (const auto& [t, step] : steps) {
      EXPECT_NEAR(step.step.yaw, 0.02, 1e-12);
      EXPECT_NEAR(step.step.x, 0.1 * std::cos(0.01), 1e-12);
      pose = pose * step.step;
    }
    EXPECT_NEAR(pose.yaw, 2, 1e-9);
    EXPECT_NEAR(pose.x, 5 * std::sin(2), 1e-3);  // the chord is shorter than the arc by 2e-5
    EXPECT_NEAR(pose.y, 5 - 5 * std::cos(2), 1e-3);
    ASSERT_TRUE(log.odometry.has_value());
    EXPECT_NEAR(log.odometry->yaw_per_second, 1e-5, 1e-12);  // 1e-4 (rad/s)^2, ten times a second
    EXPECT_EQ(log.odometry->yaw_per_metre, 0);
    EXPECT_THAT(log.remarks,
                Contains(HasSubstr("the odometry has no yaw: 101 angular velocities of /imu give it")));
  }
}

TEST_F(BagSensors, AGyroBesideOdometryWithAYawIsNotUsedAndSaidSo) {
  MadeBag bag;
  for (int i = 0; i < 4; ++i) {
    bag.push_back(made_odometry(false, i, i, 0, 0.1 * i));
    bag.push_back(made_imu(false, i, {.rate = 5}));
  }
  const RobotLog log = read(bag);
  for (const auto& [t, step] : of_kind<StepReading>(log)) EXPECT_NEAR(step.step.yaw, 0.1, 1e-12);
  EXPECT_FALSE(log.odometry.has_value());
  EXPECT_THAT(log.remarks,
              Contains(HasSubstr("4 angular velocities of /imu are not used: the odometry has a yaw")));
}

TEST_F(BagSensors, RatesThatAreNotMeasuredAreNotUsed) {
  MadeBag bag;
  for (int i = 0; i < 4; ++i) {
    bag.push_back(made_odometry(false, i, i, 0, 0));
    bag.push_back(made_imu(false, i, {.rate_first = -1, .rate = 5}));
  }
  const RobotLog log = read(bag);
  for (const auto& [t, step] : of_kind<StepReading>(log)) EXPECT_EQ(step.step.yaw, 0);
  EXPECT_THAT(log.remarks, Not(Contains(HasSubstr("angular velocities"))));
}

TEST_F(BagSensors, OrientationsAreHeadingsOfTheRobotIfTheyAreMeasured) {
  const RobotLog log =
      read({made_odometry(false, 0, 0, 0, 0), made_frame(false, "base_link", "imu", 0, 0, 0.5),
            made_imu(false, 1, {.orientation_first = 0.04, .yaw = 2, .yaw_variance = 0.04}),
            made_imu(false, 2, {.orientation_first = -1, .yaw = 2, .yaw_variance = 0.04}),
            made_imu(false, 3, {.orientation_first = 0, .yaw = 2, .yaw_variance = 0})});
  const auto headings = of_kind<HeadingFix>(log);
  ASSERT_EQ(headings.size(), 1u);
  EXPECT_EQ(headings[0].first, 1);
  EXPECT_NEAR(headings[0].second.yaw, 1.5, 1e-12);  // the sensor is turned by 0.5 on the robot
  EXPECT_DOUBLE_EQ(headings[0].second.sd, 0.2);
  EXPECT_THAT(log.remarks, Contains(HasSubstr("1 orientations of /imu are read as a compass")));
  EXPECT_THAT(log.remarks,
              Contains(HasSubstr("1 orientations of /imu state no covariance and are not used")));
  const RobotLog over =
      read({made_odometry(false, 0, 0, 0, 0), made_frame(false, "base_link", "imu", 0, 0, 0, true),
            made_imu(false, 1, {.orientation_first = 0.01, .yaw = 2, .yaw_variance = 0.01, .over = true})});
  EXPECT_NEAR(of_kind<HeadingFix>(over).at(0).second.yaw, 2, 1e-12);
}

std::vector<Eigen::Vector3f> points_of(const MadeMessage& message) {
  return importers::read_cloud(
             {.topic = message.topic, .type = message.type, .received = 0, .bytes = message.bytes})
      .points;
}

TEST_F(BagSensors, CloudsOfAnyLayoutHoldTheSamePoints) {
  const std::vector<std::array<double, 3>> points{{1, -2, 3}, {4, 5, -6}, {kNone, 0, 0}, {7, 8, 9}};
  const std::vector<Eigen::Vector3f> expected{{1, -2, 3}, {4, 5, -6}, {7, 8, 9}};
  for (const bool big : {false, true})
    for (const bool big_data : {false, true})
      for (const std::uint32_t rows : {1u, 2u})
        for (const std::uint32_t padding : {0u, 5u}) {
          MadeCloud cloud{.rows = rows, .row_padding = padding, .big_data = big_data};
          EXPECT_EQ(points_of(made_cloud(big, 1, points, cloud)), expected);
          cloud.fields = {{"ring", 0, 4}, {"z", 3, 8}, {"intensity", 11, 2}, {"x", 12, 8}, {"y", 21, 7}};
          cloud.point_step = 30;
          EXPECT_EQ(points_of(made_cloud(big, 1, points, cloud)), expected);
        }
  // Whole numbers of each type.
  const std::vector<std::array<double, 3>> whole{{1, 2, 100}, {3, 120, 5}};
  for (int type = 1; type <= 8; ++type) {
    const MadeCloud cloud{.fields = {{"y", 0, type}, {"x", 8, type}, {"z", 16, type}}, .point_step = 24};
    EXPECT_EQ(points_of(made_cloud(false, 1, whole, cloud)),
              (std::vector<Eigen::Vector3f>{{1, 2, 100}, {3, 120, 5}}))
        << type;
  }
  const MadeCloud negative{.fields = {{"x", 0, 1}, {"y", 1, 3}, {"z", 3, 5}}, .point_step = 7};
  EXPECT_EQ(points_of(made_cloud(false, 1, {{-1, -300, -9000}}, negative)).at(0),
            Eigen::Vector3f(-1, -300, -9000));
}

TEST_F(BagSensors, CloudsHoldTheIntensitiesOfTheirPoints) {
  const auto intensities_of = [](const MadeCloud& cloud) {
    const MadeMessage message = made_cloud(false, 1, {{1, 2, 3}, {kNone, 0, 0}, {4, 5, 6}}, cloud);
    return importers::read_cloud(
               {.topic = message.topic, .type = message.type, .received = 0, .bytes = message.bytes})
        .intensities;
  };
  MadeCloud cloud{.fields = {{"intensity", 12, 4}, {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}}, .point_step = 14};
  EXPECT_EQ(intensities_of(cloud), (std::vector<float>{77, 77}));
  cloud.fields[0].name = "reflectivity";
  EXPECT_EQ(intensities_of(cloud), (std::vector<float>{77, 77}));
  cloud.fields[0].name = "ring";
  EXPECT_TRUE(intensities_of(cloud).empty());
  cloud.fields.push_back({"intensity", 4, 9});  // of no known type
  EXPECT_TRUE(intensities_of(cloud).empty());
}

TEST_F(BagSensors, CloudsThatCannotBeAreRefusedWithoutMemory) {
  const std::vector<std::array<double, 3>> points{{1, 2, 3}, {4, 5, 6}};
  const auto problem = [](const MadeMessage& message) -> std::string {
    try {
      points_of(message);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem(made_cloud(false, 1, points, {.fields = {{"x", 0, 7}, {"y", 4, 7}}})),
              HasSubstr("lacks x, y or z"));
  EXPECT_THAT(problem(made_cloud(false, 1, {}, {.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 9}}})),
              HasSubstr("unknown type 9"));
  EXPECT_THAT(problem(made_cloud(false, 1, {{1e6, 0, 0}})), HasSubstr("10 km"));
  // Heights, widths, steps and sizes of any value: the message bounds what is taken.
  const MadeMessage whole = made_cloud(false, 1, points);
  const std::size_t counts =
      whole.bytes.find("scanner") + 8;  // rows, columns, fields, then further on the steps
  for (std::size_t at = counts; at + 4 <= whole.bytes.size(); ++at)
    for (const std::uint32_t value : {0u, 1u, 3u, 0x7fffffffu, 0xffffffffu, 0x80000001u}) {
      MadeMessage damaged = whole;
      std::memcpy(damaged.bytes.data() + at, &value, sizeof value);
      static_cast<void>(problem(damaged));
    }
  for (std::size_t size = 0; size < whole.bytes.size() - 1; ++size) {
    MadeMessage cut = whole;
    cut.bytes.resize(size);
    EXPECT_EQ(size < whole.bytes.size() - 1, !problem(cut).empty()) << size;
  }
}

/// Points of a ground and of two posts, as a scanner sees them whose pose on the robot is body_from_scanner.
std::vector<std::array<double, 3>> made_posts(const Eigen::Isometry3d& body_from_scanner) {
  std::vector<std::array<double, 3>> points;
  const Eigen::Isometry3d scanner_from_body = body_from_scanner.inverse();
  const auto add = [&](double x, double y, double z) {
    const Eigen::Vector3d p = scanner_from_body * Eigen::Vector3d(x, y, z);
    points.push_back({p.x(), p.y(), p.z()});
  };
  for (int i = -60; i <= 60; ++i)
    for (int k = -60; k <= 60; ++k) add(0.25 * i, 0.25 * k, 0);
  for (const auto& [x, y] : {std::pair(6.0, 2.0), std::pair(-3.0, -7.0)})
    for (int k = 0; k < 50; ++k)
      for (int a = 0; a < 8; ++a)
        add(x + 0.1 * std::cos(a * std::numbers::pi / 4), y + 0.1 * std::sin(a * std::numbers::pi / 4),
            0.05 + 0.05 * k);
  return points;
}

TEST_F(BagSensors, CloudsBecomeSightingsInTheFrameOfTheRobot) {
  // A level scanner, one that is turned, and one that looks along its z axis as depth cameras do.
  const double c = std::sqrt(0.5);
  for (const Eigen::Quaterniond& turn : {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(c, 0, 0, c),
                                         Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5)}) {
    const Eigen::Isometry3d place = Eigen::Translation3d(0.5, 0.1, 1.5) * turn;
    MadeCdr frame(false);
    frame.add(std::uint32_t{1}).header(0, "base_link").text("scanner").add(0.5).add(0.1).add(1.5);
    frame.add(turn.x()).add(turn.y()).add(turn.z()).add(turn.w());
    // The transform comes after the cloud.
    const RobotLog log = read({made_cloud(false, 1, made_posts(place)),
                               made_cloud(true, 2, made_posts(place)),
                               {"/tf_static", "tf2_msgs/msg/TFMessage", frame.bytes()}});
    const auto sets = of_kind<SightingSet>(log);
    ASSERT_EQ(sets.size(), 2u);
    for (const auto& [t, set] : sets) {
      ASSERT_EQ(set.sightings.size(), 2u);
      std::vector<Eigen::Vector2d> at;
      for (const SeenLandmark& s : set.sightings) {
        const double along = set.robot_from_sensor.yaw + *s.bearing;
        at.push_back(set.robot_from_sensor.at() +
                     *s.range * Eigen::Vector2d(std::cos(along), std::sin(along)));
        EXPECT_EQ(types_[*s.type].name, "pole");
      }
      if (at[0].x() < at[1].x()) std::swap(at[0], at[1]);
      EXPECT_LT((at[0] - Eigen::Vector2d(6, 2)).norm(), 0.05);
      EXPECT_LT((at[1] - Eigen::Vector2d(-3, -7)).norm(), 0.05);
    }
  }
}

TEST_F(BagSensors, CloudsAreLeftOutIfTheMapHoldsNothingThatTheyShow) {
  const MadeBag bag{made_cloud(false, 1, {{1, 2, 3}}), made_odometry(false, 1, 0, 0, 0)};
  const std::vector<TypeId> held{types_.id("crater")};
  EXPECT_THAT(read(bag, {.held_types = held}).remarks,
              Contains(HasSubstr("1 point clouds of /points are not used: the map has no landmarks")));
  write_rosbag2(folder_ / "made.db3", bag);
  EXPECT_THAT(importers::import_log(folder_ / "made.db3", {}).remarks, Contains(HasSubstr("are not used")));
}

TEST_F(BagSensors, TopicsOfEachKindCanBeNamed) {
  MadeBag bag = arc_without_yaw(false, 1, false);
  for (int i = 0; i < 3; ++i) bag.push_back(made_imu(false, 10 + i, {.rate = 0, .topic = "/imu_rear"}));
  EXPECT_THAT(read(bag).remarks,
              Contains(HasSubstr(
                  "inertial readings are read from /imu, which has the most messages; not from /imu_rear")));
  const RobotLog log = read(bag, {.topics = {"/imu_rear"}});
  for (const auto& [t, step] : of_kind<StepReading>(log)) EXPECT_EQ(step.step.yaw, 0);
}

TEST_F(BagSensors, WhatIsNotReadIsNamedByTopicTypeAndCount) {
  const RobotLog log = read({made_odometry(false, 1, 0, 0, 0),
                             {"/camera", "sensor_msgs/msg/Image", ""},
                             {"/camera", "sensor_msgs/msg/Image", ""},
                             {"/rear", "sensor_msgs/msg/Image", ""}});
  EXPECT_THAT(log.remarks, Contains("2 messages of type sensor_msgs/msg/Image of /camera are skipped"));
  EXPECT_THAT(log.remarks, Contains("1 messages of type sensor_msgs/msg/Image of /rear are skipped"));
}

TEST_F(BagSensors, GyroYawIsThatOfTheSlowTwin) {
  std::mt19937 random(5);
  const auto uniform = [&] { return double(random() % 10000) / 10000; };
  std::vector<importers::TurnRate> rates;
  std::vector<StampedPose> poses;
  for (int i = 0; i < 40; ++i)
    rates.push_back({.t = i + 0.5 * uniform(), .rate = uniform() - 0.5, .variance = 0.01});
  for (int i = 0; i < 30; ++i) poses.push_back({-3 + 1.7 * i, {double(i), 0.5 * i, 0.3}});
  const auto rate_at = [&](double t) {
    for (std::size_t i = 1; i < rates.size(); ++i)
      if (rates[i - 1].t <= t && t < rates[i].t)
        return rates[i - 1].rate +
               (t - rates[i - 1].t) / (rates[i].t - rates[i - 1].t) * (rates[i].rate - rates[i - 1].rate);
    return 0.0;
  };
  const auto turned = importers::with_yaw_of_gyro(poses, rates);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    double yaw = 0;
    constexpr int kSteps = 20000;
    const double dt = (poses[i].t - poses[i - 1].t) / kSteps;
    for (int k = 0; k < kSteps; ++k) yaw += dt * rate_at(poses[i - 1].t + (k + 0.5) * dt);
    const Pose2 step = inverse(turned[i - 1].pose) * turned[i].pose,
                own = inverse(poses[i - 1].pose) * poses[i].pose;
    EXPECT_NEAR(step.yaw, yaw, 1e-4);
    EXPECT_NEAR(step.at().norm(), own.at().norm(), 1e-12);
    EXPECT_NEAR(
        std::remainder(std::atan2(step.y, step.x) - std::atan2(own.y, own.x) - yaw / 2, 2 * std::numbers::pi),
        0, 1e-4);
  }
}

// A crash, an endless loop or an allocation beyond the file's size ends the test program.
TEST_F(BagSensors, MutatedFilesAreReadOrRefused) {
  MadeBag bag = arc_without_yaw(true, 1, false);
  bag.resize(40);
  for (int i = 0; i < 3; ++i) {  // a detector takes some milliseconds for a cloud of any size
    bag.push_back(made_fix(i % 2 != 0, 10 + i, {}));
    bag.push_back(made_cloud(i % 2 != 0, 10 + i, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1, 1, 1}}, {.rows = 2}));
  }
  write_rosbag2(folder_ / "whole.db3", bag);
  const std::string database = read_text(folder_ / "whole.db3", "the bag");
  int refused = 0, read = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const bool mcap = seed % 2 == 0;
    const std::string bytes = mutated_bag(bag, database, seed);
    const fs::path file = folder_ / (mcap ? "m.mcap" : "m.db3");
    std::ofstream(file, std::ios::binary) << bytes;
    try {
      importers::import_log(file, types_);
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
