// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "core/units.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/detectors/wall_features.hpp"
#include "localization/identification/feature_distance.hpp"
#include "tests/localization/made_rooms.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;

constexpr double kDegree = kRadiansPerDegree;
// A room of 6 x 4 m, its lower left corner in the origin.
const std::vector<MadeWall> kRoom = chain({{0, 0}, {6, 0}, {6, 4}, {0, 4}, {0, 0}});

std::vector<WallCorner> corners_of(const std::vector<MadeWall>& walls, const Pose2& sensor, double sd = 0,
                                   std::uint64_t seed = 1) {
  const LaserScan scan = scan_walls(walls, sensor, 721, 2 * std::numbers::pi, sd, seed);
  return find_wall_corners(find_wall_lines(scan));
}

TEST(WallCorners, OfARoomAreConcaveAndFaceItsMiddle) {
  const Pose2 sensor{2.5, 1.7, 0.3};
  const auto corners = corners_of(kRoom, sensor);
  ASSERT_EQ(corners.size(), 4u);
  for (const WallCorner& corner : corners) {
    const Pose2 at = sensor * Pose2{corner.at.x(), corner.at.y(), corner.direction};
    EXPECT_NEAR(std::abs(at.x - 3), 3, 1e-3);
    EXPECT_NEAR(std::abs(at.y - 2), 2, 1e-3);
    EXPECT_NEAR(corner.opening_angle, kRightAngle, 1e-3);
    const double middle = std::atan2(2 - at.y > 0 ? 1 : -1, 3 - at.x > 0 ? 1 : -1);
    EXPECT_NEAR(wrap_angle(at.yaw - middle), 0, 1e-3);
  }
}

// A block of 2 x 2 m in a larger room, seen from its lower left.
TEST(WallCorners, OfABlockAreConvexAndFaceAwayFromIt) {
  std::vector<MadeWall> walls = chain({{-5, -5}, {9, -5}, {9, 9}, {-5, 9}, {-5, -5}});
  for (const MadeWall& wall : chain({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}})) walls.push_back(wall);
  const Pose2 sensor{-3, -2.5, 0};
  const auto corners = corners_of(walls, sensor);
  const auto convex =
      std::ranges::find_if(corners, [](const WallCorner& c) { return c.opening_angle > 3.2; });
  ASSERT_NE(convex, corners.end());
  EXPECT_NEAR(convex->opening_angle, 3 * kRightAngle, 1e-3);
  EXPECT_NEAR((sensor.at() + convex->at).norm(), 0, 2e-3);
  EXPECT_NEAR(convex->direction, -3 * std::numbers::pi / 4, 1e-3);
}

// A partition ends at (2, 1) before the far wall of the room.
TEST(WallEnds, LieHalfABeamBeyondTheLastHit) {
  std::vector<MadeWall> walls = kRoom;
  walls.push_back({{0, 2.5}, {2, 2.5}});
  const Pose2 sensor{2.4, 0.5, kRightAngle};
  const LaserScan scan = scan_walls(walls, sensor, 361, std::numbers::pi);
  const auto ends = find_wall_ends(scan, find_wall_lines(scan));
  ASSERT_EQ(ends.size(), 1u);
  const Pose2 at = sensor * Pose2{ends[0].at.x(), ends[0].at.y(), ends[0].direction};
  EXPECT_NEAR(at.x, 2, 0.01);
  EXPECT_NEAR(at.y, 2.5, 1e-3);
  EXPECT_NEAR(at.yaw, -kRightAngle, 1e-3);  // its seen face looks at the robot
  EXPECT_EQ(ends[0].side, 1);               // the partition is on the left
}

TEST(Doors, AreGapsOfOneWall) {
  const auto doors_of_gap = [](double width) {
    std::vector<MadeWall> walls = chain({{-4, -3}, {4, -3}, {4, 5}, {-4, 5}, {-4, -3}});
    walls.push_back({{-4, 1}, {0, 1}});
    walls.push_back({{width, 1}, {4, 1}});
    const LaserScan scan = scan_walls(walls, {0.2, -1, kRightAngle}, 721, std::numbers::pi);
    return find_doors(scan, find_wall_lines(scan));
  };
  const auto doors = doors_of_gap(0.9);
  ASSERT_EQ(doors.size(), 1u);
  EXPECT_NEAR(doors[0].width, 0.9, 0.02);
  EXPECT_NEAR(doors[0].at.x(), 2, 0.01);           // ahead of the robot
  EXPECT_NEAR(doors[0].at.y(), 0.2 - 0.45, 0.01);  // and left of it, 0.25 m to the right of the door's middle
  EXPECT_TRUE(doors_of_gap(0.4).empty());
  EXPECT_TRUE(doors_of_gap(2).empty());
}

TEST(Doors, AreClosedWithoutAGap) {
  const LaserScan scan = scan_walls(kRoom, {2, 1, 0}, 721);
  EXPECT_TRUE(find_doors(scan, find_wall_lines(scan)).empty());
}

RC_GTEST_PROP(WallCorners, TurnWithTheScan, ()) {
  const double turn = 0.01 * *rc::gen::inRange(-314, 314);
  const Pose2 sensor{0.1 * *rc::gen::inRange(10, 50), 0.1 * *rc::gen::inRange(10, 30), turn};
  const auto corners = corners_of(kRoom, sensor);
  RC_ASSERT(corners.size() >= 3u);  // a corner behind the robot is cut in two
  for (const WallCorner& corner : corners) {
    const Pose2 at = sensor * Pose2{corner.at.x(), corner.at.y(), corner.direction};
    const double middle = std::atan2(at.y < 2 ? 1 : -1, at.x < 3 ? 1 : -1);
    RC_ASSERT(std::abs(std::abs(at.x - 3) - 3) < 5e-3);
    RC_ASSERT(std::abs(std::abs(at.y - 2) - 2) < 5e-3);
    RC_ASSERT(std::abs(wrap_angle(at.yaw - middle)) < 5e-3);
  }
}

RC_GTEST_PROP(WallCorners, AreMirroredWithTheScan, ()) {
  const Pose2 sensor{0.1 * *rc::gen::inRange(10, 50), 0.1 * *rc::gen::inRange(10, 30), 0.2};
  LaserScan scan = scan_walls(kRoom, sensor, 541, 1.5 * std::numbers::pi, 0.01, 3);
  const auto corners = find_wall_corners(find_wall_lines(scan));
  std::ranges::reverse(scan.ranges);
  auto mirrored = find_wall_corners(find_wall_lines(scan));
  std::ranges::reverse(mirrored);
  RC_ASSERT(mirrored.size() == corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    RC_ASSERT(std::abs(mirrored[i].at.x() - corners[i].at.x()) < 0.05);
    RC_ASSERT(std::abs(mirrored[i].at.y() + corners[i].at.y()) < 0.05);
  }
}

// Positions where the piece between two walls fell to the one that the scanner met first.
TEST(WallLines, DoNotDependOnTheTurnOfTheScanner) {
  for (const Pose2& sensor : {Pose2{1.7, 2.9, 0.2}, Pose2{2.4, 2.1, 0.2}}) {
    LaserScan scan = scan_walls(kRoom, sensor, 541, 1.5 * std::numbers::pi, 0.01, 3);
    const std::size_t last_beam = scan.ranges.size() - 1;
    const auto lines = find_wall_lines(scan);
    std::ranges::reverse(scan.ranges);
    auto mirrored = find_wall_lines(scan);
    std::ranges::reverse(mirrored);
    ASSERT_EQ(mirrored.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_EQ(mirrored[i].first, last_beam - lines[i].last);
      EXPECT_EQ(mirrored[i].last, last_beam - lines[i].first);
    }
  }
}

// The slow twin: the line of least squares among all angles.
TEST(WallLines, AreThoseOfLeastSquares) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<MadeWall> wall = chain({{2, -1.5}, {2.7, 1.5}});
    const LaserScan scan = scan_walls(wall, {}, 91, kRightAngle, 0.02, seed);
    const auto lines = find_wall_lines(scan, {.tolerance = 0.2});
    ASSERT_EQ(lines.size(), 1u) << seed;
    const WallLine& line = lines[0];
    double best = 1e9, best_angle = 0;
    for (double angle = 0; angle < std::numbers::pi; angle += 2e-4) {
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
      double sum = 0, squares = 0;
      for (std::size_t i = line.first; i <= line.last; ++i) {
        const double beam = scan.first_angle + static_cast<double>(i) * scan.angle_step;
        const double d =
            static_cast<double>(scan.ranges[i]) * normal.dot(Eigen::Vector2d(std::cos(beam), std::sin(beam)));
        sum += d, squares += d * d;
      }
      const double residual = squares - sum * sum / static_cast<double>(line.last - line.first + 1);
      if (residual < best) best = residual, best_angle = angle;
    }
    EXPECT_NEAR(difference(std::atan2(line.normal.y(), line.normal.x()), best_angle, Scale::axis), 0, 3e-4)
        << seed;
  }
}

// Errors of corners agree with their covariances, apart from the floor for crooked walls.
TEST(WallCorners, HaveHonestCovariances) {
  double position = 0, direction = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const LaserScan scan = scan_walls(kRoom, {2.5, 1.7, 0}, 361, std::numbers::pi, 0.02, seed);
    for (const WallCorner& corner :
         find_wall_corners(find_wall_lines(scan, {.beam_sd = 0.001}), {.position_sd = 0, .angle_sd = 0})) {
      const Eigen::Vector2d truth(3.5, corner.at.y() > 0 ? 2.3 : -1.7);
      const Eigen::Vector2d error = corner.at - truth;
      position += error.dot(corner.covariance.inverse() * error) / 2;
      const double off = wrap_angle(corner.direction - (corner.at.y() > 0 ? -135 : 135) * kDegree);
      direction += off * off / corner.direction_variance;
      ++count;
    }
  }
  ASSERT_GT(count, 300);
  EXPECT_NEAR(position / count, 1, 0.3);
  EXPECT_NEAR(direction / count, 1, 0.3);
}

TEST(WallLines, OfScansWithoutReturnsAreNone) {
  EXPECT_TRUE(find_wall_lines({}).empty());
  LaserScan scan = scan_walls(kRoom, {2, 1, 0}, 181, std::numbers::pi);
  for (const float bad : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), 1e9F}) {
    std::ranges::fill(scan.ranges, bad);
    const auto lines = find_wall_lines(scan);
    EXPECT_TRUE(lines.empty()) << bad;
    EXPECT_TRUE(find_wall_ends(scan, lines).empty());
  }
  std::ranges::fill(scan.ranges, 1e-9F);  // all hits in one point
  EXPECT_TRUE(find_wall_lines(scan).empty());
  scan.ranges = {2};
  EXPECT_TRUE(find_wall_lines(scan).empty());
}

TypeRegistry types_named(const std::vector<std::string>& names) {
  TypeRegistry all, some;
  register_landmark_types(all);
  for (const std::string& name : names) some.add(*all.find(name));
  return some;
}

std::vector<std::optional<TypeId>> types_seen(const LaserScan& scan, const std::vector<std::string>& names,
                                              const std::string& find = "auto") {
  std::vector<std::optional<TypeId>> seen;
  for (const SeenLandmark& s : make_laser_detector(types_named(names), {.find = find})(scan).sightings)
    seen.push_back(s.type);
  return seen;
}

LaserScan scan_of_a_post() {
  LaserScan scan{.robot_from_sensor = {},
                 .first_angle = -1.5,
                 .angle_step = 0.01,
                 .ranges = std::vector<float>(301, 81.0F),
                 .max_range = 80};
  for (const std::size_t i : {150, 151, 152, 153, 154}) scan.ranges[i] = 4;
  return scan;
}

TEST(Detectors, AreChosenByTheTypesOfTheMap) {
  const LaserScan post = scan_of_a_post();
  const auto first = std::vector{std::optional<TypeId>(TypeId{0})};
  EXPECT_EQ(types_seen(post, {"tree"}), first);
  EXPECT_EQ(types_seen(post, {"pole"}), first);
  EXPECT_EQ(types_seen(post, {"beacon"}), std::vector{std::optional<TypeId>()});  // stems of no type
  EXPECT_EQ(types_seen(post, {"tree", "pole"}), std::vector{std::optional<TypeId>()}) << "one object";
  EXPECT_TRUE(types_seen(post, {"wall_corner"}).empty());
  EXPECT_EQ(types_seen(post, {"tree", "pole"}, "stems,poles").size(), 2u);
  const LaserScan room = scan_walls(kRoom, {2.5, 1.7, 0}, 361);
  EXPECT_GE(types_seen(room, {"wall_corner", "tree"}).size(), 3u);
  EXPECT_TRUE(types_seen(room, {"tree"}).empty());
}

TEST(Detectors, AreThoseOfTheTypesThatTheMapHolds) {
  const LaserScan post = scan_of_a_post();
  TypeRegistry types;
  register_landmark_types(types);
  const auto seen = [&](const LaserScan& scan, const std::string& find, const std::vector<TypeId>& held) {
    std::set<std::optional<TypeId>> all;
    for (const SeenLandmark& s : make_laser_detector(types, {.find = find}, held)(scan).sightings)
      all.insert(s.type);
    return all;
  };
  using Types = std::set<std::optional<TypeId>>;
  for (const char* name : {"pole", "tree"})
    EXPECT_EQ(seen(post, "auto", {types.id(name)}), Types{types.id(name)});
  EXPECT_EQ(seen(post, "poles", {types.id("tree")}), Types{types.id("pole")}) << "named, so asked for";
  EXPECT_EQ(seen(post, "auto", {types.id("beacon")}), Types{std::nullopt}) << "stems of no type";
  EXPECT_EQ(seen(scan_walls(kRoom, {2.5, 1.7, 0}, 361), "auto", {types.id("wall_corner")}),
            Types{types.id("wall_corner")});
}

// Of 5 beams 0.2 m wide, of 15 beams 0.6 m.
TEST(Detectors, MakeOneSightingOfAnObject) {
  const TypeRegistry types = types_named({"pole", "rock", "tree", "wall_corner"});
  const auto seen = [&](std::size_t beams, const std::vector<TypeId>& held, bool with_features = true) {
    LaserScan scan = scan_of_a_post();
    for (std::size_t i = 0; i < beams; ++i) scan.ranges[150 + i] = 4;
    const SightingSet set =
        make_laser_detector(types, {.find = "auto", .features = with_features}, held)(scan);
    EXPECT_EQ(set.sightings.size(), 1u);
    return set.sightings.at(0);
  };
  const TypeId pole = types.id("pole"), rock = types.id("rock"), tree = types.id("tree");
  const std::vector<TypeId> both{pole, tree}, all{pole, rock, tree, types.id("wall_corner")};
  EXPECT_EQ(types_of(seen(5, both)), both);
  EXPECT_EQ(types_of(seen(15, both)), std::vector{tree}) << "too wide for a pole";
  EXPECT_EQ(types_of(seen(5, {pole})), std::vector{pole}) << "the map holds no trees";
  EXPECT_EQ(types_of(seen(5, all)), (std::vector{pole, rock, tree}));
  const SeenLandmark either = seen(5, both);
  for (const TypeId type : both) {
    const std::size_t diameter = feature_index(types[type], "diameter");
    EXPECT_NEAR(either.features_as(type)->value[diameter], 0.2, 0.03);
    EXPECT_FALSE(seen(5, both, false).features_as(type)->known(diameter));
  }
}

TEST(Detectors, WithUnknownNamesAreRefusedWithTheKnownOnes) {
  try {
    make_laser_detector({}, {.find = "stems,wals"});
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("there is no detector 'wals'"));
    EXPECT_THAT(e.what(), HasSubstr("doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls"));
  }
  EXPECT_THROW(make_laser_detector({}, {.find = ""}), Error);
}

// What a sighting says of a corner in the map does not depend on where the robot stands.
RC_GTEST_PROP(Detectors, GiveCornersTheirDirectionInTheMap, ()) {
  const TypeRegistry types = types_named({"wall_corner"});
  const Pose2 sensor{0.1 * *rc::gen::inRange(15, 45), 0.1 * *rc::gen::inRange(15, 25),
                     0.01 * *rc::gen::inRange(-314, 314)};
  const LaserScan scan = scan_walls(kRoom, sensor, 721);
  const SightingSet set = make_laser_detector(types, {})(scan);
  RC_ASSERT(set.sightings.size() >= 3u);
  for (const SeenLandmark& s : set.sightings) {
    const KnownFeatures mapped = features_in_map(FeatureScales(types), 0, s.features, sensor.yaw);
    const double along = sensor.yaw + *s.bearing;
    const double x = sensor.x + *s.range * std::cos(along), y = sensor.y + *s.range * std::sin(along);
    const double azimuth = std::atan2(x < 3 ? 1 : -1, y < 2 ? 1 : -1);  // clockwise from north, into the room
    RC_ASSERT(std::abs(wrap_angle(mapped.value[0] - azimuth)) < 0.01);
    RC_ASSERT(std::abs(mapped.value[1] - kRightAngle) < 0.01);
  }
}

}  // namespace
}  // namespace waymark::test
