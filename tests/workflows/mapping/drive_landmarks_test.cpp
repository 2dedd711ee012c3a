// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/drive_landmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "core/atomic_file.hpp"
#include "core/locked_folder.hpp"
#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"
#include "geo/point_at_height.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "testbed/town/town_drive.hpp"
#include "tests/localization/made_rooms.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

constexpr double kRight = std::numbers::pi / 2;

// A room of 8 x 6 m with a thin partition that ends at (4, 3), seen from both of its sides.
std::vector<MadeWall> partitioned_room() {
  std::vector<MadeWall> walls = chain({{0, 0}, {8, 0}, {8, 6}, {0, 6}, {0, 0}});
  walls.push_back({{0, 3}, {4, 3}});
  return walls;
}

RobotLog drive_around(std::vector<StampedPose>& poses, double sd = 0.01) {
  RobotLog log;
  const std::vector<MadeWall> walls = partitioned_room();
  double t = 0;
  for (const auto& [from, to] : {std::pair(Pose2{1, 1.5, 0}, Pose2{6, 1.5, 0}),
                                 std::pair(Pose2{6, 1.5, kRight}, Pose2{6, 4.5, kRight}),
                                 std::pair(Pose2{6, 4.5, std::numbers::pi}, Pose2{1, 4.5, std::numbers::pi})})
    for (int i = 0; i <= 20; ++i) {
      const double k = i / 20.0;
      const Pose2 pose{from.x + k * (to.x - from.x), from.y + k * (to.y - from.y), from.yaw};
      poses.push_back({t, pose});
      log.events.push_back(
          {t, scan_walls(walls, pose, 361, std::numbers::pi, sd, static_cast<std::uint64_t>(10 * t) + 1)});
      t += 0.1;
    }
  return log;
}

std::vector<DriveLook> made_looks() {
  std::vector<StampedPose> poses;
  const RobotLog log = drive_around(poses);
  return looks_of_drive(log, poses, make_laser_detector(all_types(), {.find = "walls"}), "made");
}

// A wall of 20 m along y = 8; each look sees another piece of 6 m.
TEST(DriveLandmarks, PiecesOfALineAreOneWall) {
  const TypeRegistry& types = all_types();
  const TypeId wall = types.id("wall");
  const LineFeatures line = *line_features(types[wall]);
  std::vector<DriveLook> looks;
  for (int i = 0; i <= 14; ++i) {
    SeenLandmark s;
    s.type = wall, s.range = 8 + (i % 2 ? 0.02 : -0.02), s.range_sd = 0.03;
    s.extent = {-3, 3};
    s.features.value[line.direction] = -kRight - 0.2, s.features.variance[line.direction] = 1e-4;
    looks.push_back({.name = "look " + std::to_string(i),
                     .map_from_sensor = {-7.0 + i, 0, 0.2},
                     .seen = {{}, {s}},
                     .scan = {}});
  }
  const auto made = landmarks_of_looks(looks, types, LocalFrame(Crs::local(), {}));
  ASSERT_EQ(made.landmarks.size(), 1U);
  EXPECT_EQ(made.unplaced, 0);
  const Landmark& l = made.landmarks[0];
  EXPECT_NEAR(l.position.xyz.x(), 0, 0.2);
  EXPECT_NEAR(l.position.xyz.y(), 8, 0.02);
  EXPECT_NEAR(std::abs(l.features[line.direction].value), std::numbers::pi, 0.01)
      << "its normal points south";
  EXPECT_NEAR(l.features[line.length].value, 20, 0.2);
  EXPECT_GT(std::sqrt(l.covariance(0, 0)), 5) << "unknown along itself";
  EXPECT_LT(std::sqrt(l.covariance(1, 1)), 0.05);
}

TEST(DriveLandmarks, AreTheCornersOfTheRoom) {
  const auto made = landmarks_of_looks(made_looks(), all_types(), LocalFrame(Crs::local(), {}));
  const TypeId corner = all_types().id("wall_corner");
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(8, 0), Eigen::Vector2d(8, 6), Eigen::Vector2d(0, 6)}) {
    const auto found = std::ranges::count_if(made.landmarks, [&](const Landmark& l) {
      return l.type == corner && (l.position.xyz.head<2>() - at).norm() < 0.05;
    });
    EXPECT_EQ(found, 1) << at.transpose();
  }
  for (const Landmark& l : made.landmarks) {
    EXPECT_GE(l.quality.visible, l.quality.seen) << l.uid;
    EXPECT_GT(l.quality.seen, 1) << l.uid;
    EXPECT_GE(l.confidence, 0.5) << l.uid;
    EXPECT_LT(std::sqrt(l.covariance(0, 0)), 0.1) << l.uid;
  }
  for (const Observation& o : made.evidence) EXPECT_EQ(o.rejected.empty(), !o.landmark_uid.empty());
}

// Units of feet, a grid whose scale is 2.1, and axes turned by 90 degrees.
TEST(DriveLandmarks, AreTheSameInAnyCrs) {
  const std::vector<DriveLook> looks = made_looks();
  const auto expected = landmarks_of_looks(looks, all_types(), LocalFrame(Crs::local(), {}));
  const auto nearest = [&](const Landmark& l, const Eigen::Vector2d& at) {
    return *std::ranges::min_element(expected.landmarks, {}, [&](const Landmark& e) {
      return (e.position.xyz.head<2>() - at).norm() + (e.type == l.type ? 0 : 100) +
             std::abs(difference(e.features[0].value, l.features[0].value, Scale::direction));
    });
  };
  for (const auto& [name, lon, lat] :
       {std::tuple("EPSG:2263", -74.0, 40.7), std::tuple("EPSG:3857", 5.0, 62.0),
        std::tuple("EPSG:4326", 5.0, 62.0), std::tuple("IAU_2015:30135", 90.0, -89.0)}) {
    const Crs crs = Crs::from_text(name);
    const auto at = CrsTransform(geographic_crs(crs), crs)(lon, lat);
    const LocalFrame frame(crs, {{at.x, at.y, 0}});
    const auto made = landmarks_of_looks(looks, all_types(), frame);
    EXPECT_EQ(made.landmarks.size(), expected.landmarks.size()) << name;
    EXPECT_EQ(made.improbable, expected.improbable) << name;
    for (Landmark l : made.landmarks) {
      const Eigen::Vector2d there = plan_position(frame, l.position.xyz.x(), l.position.xyz.y());
      const LandmarkType& type = all_types()[l.type];
      rotate_axes(l, type.features, -grid_rotation(frame, there));
      const Landmark same = nearest(l, there);
      EXPECT_LT((same.position.xyz.head<2>() - there).norm(), 1e-3) << name;
      const Eigen::Matrix3d off = same.covariance - l.covariance;
      EXPECT_LT((off.topLeftCorner<2, 2>().norm()), 1e-6) << name;
      EXPECT_NEAR(difference(same.features[0].value, l.features[0].value, type.features[0].scale), 0, 1e-3)
          << name;
      EXPECT_EQ(same.quality.seen, l.quality.seen) << name;
      EXPECT_EQ(same.quality.visible, l.quality.visible) << name;
    }
  }
}

TEST(DriveLandmarks, SightingsOutOfRangeAreCounted) {
  const auto looks = made_looks();
  std::int64_t far = 0, all = 0;
  for (const DriveLook& look : looks)
    for (const SeenLandmark& s : look.seen.sightings) ++all, far += *s.range > 3;
  ASSERT_GT(far, 0);
  ASSERT_LT(far, all);
  const auto made = landmarks_of_looks(looks, all_types(), LocalFrame(Crs::local(), {}), {.max_range = 3});
  EXPECT_EQ(made.too_far, far);
  EXPECT_EQ(std::ssize(made.evidence), all - far);
  EXPECT_EQ(landmarks_of_looks(looks, all_types(), LocalFrame(Crs::local(), {})).too_far, 0);
}

TEST(DriveLandmarks, SightingsWithoutPositionOrTypeAreCounted) {
  auto looks = made_looks();
  const std::size_t all =
      landmarks_of_looks(looks, all_types(), LocalFrame(Crs::local(), {})).evidence.size();
  std::vector<SeenLandmark>& seen = looks.at(3).seen.sightings;
  ASSERT_GE(seen.size(), 2u);
  seen[0].bearing.reset();
  seen[1].type.reset(), seen[1].possible_types = {{.type = 0, .features = {}}, {.type = 1, .features = {}}};
  const auto made = landmarks_of_looks(looks, all_types(), LocalFrame(Crs::local(), {}));
  EXPECT_EQ(made.unplaced, 1);
  EXPECT_EQ(made.untyped, 1);
  EXPECT_EQ(made.evidence.size(), all - 2);
}

// Both faces of the partition end at one position, and look in opposite directions.
TEST(DriveLandmarks, OfTwoFacesOfOneWallStayTwo) {
  const auto made = landmarks_of_looks(made_looks(), all_types(), LocalFrame(Crs::local(), {}));
  const TypeId end = all_types().id("wall_end");
  std::vector<double> facing;
  for (const Landmark& l : made.landmarks)
    if (l.type == end && (l.position.xyz.head<2>() - Eigen::Vector2d(4, 3)).norm() < 0.15)
      facing.push_back(l.features[0].value);
  std::ranges::sort(facing, {}, [](double azimuth) { return std::abs(azimuth); });
  ASSERT_EQ(facing.size(), 2u);
  EXPECT_NEAR(facing[0], 0, 0.03);                           // north
  EXPECT_NEAR(std::abs(facing[1]), std::numbers::pi, 0.03);  // south
}

TEST(DriveLandmarks, AStandingRobotLooksOnce) {
  RobotLog log;
  std::vector<StampedPose> poses;
  for (int i = 0; i < 50; ++i) {
    poses.push_back({0.1 * i, {1, 1.5, 0}});
    log.events.push_back({0.1 * i, scan_walls(partitioned_room(), {1, 1.5, 0}, 181, std::numbers::pi)});
  }
  const auto detect = make_laser_detector(all_types(), {.find = "walls"});
  EXPECT_EQ(looks_of_drive(log, poses, detect, "made").size(), 1u);
  EXPECT_TRUE(looks_of_drive(log, {}, detect, "made").empty());
  EXPECT_TRUE(landmarks_of_looks({}, all_types(), LocalFrame(Crs::local(), {})).landmarks.empty());
}

TEST(DriveLandmarks, AreCoveredFromTheirOpenSideOnly) {
  const DriveLook look{
      .name = "a",
      .map_from_sensor = {6, 1.5, std::numbers::pi},
      .seen = {},
      .scan = scan_walls(partitioned_room(), {6, 1.5, std::numbers::pi}, 361, std::numbers::pi)};
  const double south = std::numbers::pi, nan = std::nan("");
  EXPECT_TRUE(covers(look, {4, 3}, south, 10));
  EXPECT_FALSE(covers(look, {4, 3}, 0, 10)) << "its face looks north";
  EXPECT_FALSE(covers(look, {4, 3}, south, 2)) << "too far";
  EXPECT_TRUE(covers(look, {0, 0}, nan, 10));
  EXPECT_FALSE(covers(look, {0, 5}, nan, 10)) << "behind the partition";
  EXPECT_FALSE(covers(look, {8, 1.5}, nan, 10)) << "behind the robot";
}

TEST(DriveLandmarks, AnEmptyPlaceIsSeenThrough) {
  const auto room = chain({{0, 0}, {8, 0}, {8, 6}, {0, 6}, {0, 0}});
  auto look = DriveLook{.name = "a",
                        .map_from_sensor = {1, 3, 0},
                        .seen = {},
                        .scan = scan_walls(room, {1, 3, 0}, 721, std::numbers::pi)};
  EXPECT_TRUE(sees_through(look, {4, 3}, 0.2));
  EXPECT_FALSE(sees_through(look, {7.8, 3}, 0.2)) << "it may stand at the wall";
  EXPECT_FALSE(sees_through(look, {4, 3}, 0.01)) << "it may stand between two beams";
  EXPECT_FALSE(sees_through(look, {0.5, 3}, 0.2)) << "behind the robot";
  EXPECT_FALSE(sees_through(look, {1.1, 3}, 0.2)) << "at the robot";
  EXPECT_FALSE(sees_through(look, {4, 3}, 0)) << "no body";
  look.scan.pitch = 0.2;
  EXPECT_FALSE(sees_through(look, {4, 3}, 0.2)) << "the beams may pass above it";
  look.scan.pitch = 0;
  auto with_post = room;  // 0.1 m beside the place: as far as the poses may err
  with_post.push_back({{4, 3.12}, {4, 3.2}});
  look.scan = scan_walls(with_post, {1, 3, 0}, 721, std::numbers::pi);
  EXPECT_FALSE(sees_through(look, {4, 3}, 0.1));
  look.scan = scan_walls(room, {1, 3, 0}, 721, std::numbers::pi);
  for (float& range : look.scan.ranges) range = 0;
  EXPECT_FALSE(sees_through(look, {4, 3}, 0.2)) << "no returns";
}

// Two people walk along the corridor, and stand at each place for one or two looks.
TEST(DriveLandmarks, PeopleWhoWalkAreNoPillars) {
  for (const std::uint64_t seed : {51, 52}) {
    const testbed::Town hall = testbed::plan_hall({}, seed, seed);
    const LockedFolder folder(std::filesystem::temp_directory_path());
    const std::string file = (folder.path() / "log.jsonl").string();
    write_file(file, testbed::drive_through(hall, testbed::town_settings(), seed).log);
    RobotLog log = importers::import_log(file, all_types(), {});
    const auto looks =
        looks_of_drive(log, log.truth, make_laser_detector(all_types(), {.find = "pillars"}), "hall");
    const auto made = landmarks_of_looks(looks, all_types(), LocalFrame(Crs::local(), {}));
    int right = 0, wrong = 0;
    for (const Landmark& l : made.landmarks)
      ++(std::ranges::any_of(hall.landmarks,
                             [&](const testbed::TownLandmark& t) {
                               return t.type == "pillar" && (t.at - l.position.xyz.head<2>()).norm() < 0.3;
                             })
             ? right
             : wrong);
    std::cout << "seed " << seed << ": " << right << " pillars, " << wrong << " others, " << made.improbable
              << " improbable\n";
    EXPECT_GE(right, 2) << seed;
    EXPECT_LE(wrong, 5) << seed;
    EXPECT_GT(made.improbable, 20) << seed;
  }
}

}  // namespace
}  // namespace waymark::test
