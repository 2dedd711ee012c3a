// SPDX-License-Identifier: Apache-2.0
// What a drive changes in its map: counts per drive, and features by one more observation.
#include "workflows/localization/slam_update.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "core/locked_folder.hpp"
#include "core/random.hpp"
#include "geodb/write_map.hpp"
#include "localization/slam/existence_log_odds.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

class SlamUpdateOfARock : public ::testing::Test {
 protected:
  // A rock that three of four images detected, two of them with a radius: 0.93 and 1.07 m.
  OpenedMap make_map(const Crs& crs = Crs::local(), const Eigen::Vector3d& at = {5, 2, 0},
                     const std::vector<std::string>& empty_tables = {}) {
    const LandmarkType& type = types_[types_.id("rock")];
    rock_.type = types_.id("rock");
    rock_.uid = "rock-1";
    rock_.position = {at};
    rock_.covariance = Eigen::Matrix3d::Identity() * 0.01;
    rock_.features.resize(type.features.size());
    rock_.attributes.resize(type.attributes.size());
    rock_.observations = 2;
    rock_.quality = {.seen = 3, .visible = 4, .feature_confidences = {}};
    rock_.quality.feature_confidences.resize(type.features.size());
    const WeightedValue radii[] = {{0.93, 1}, {1.07, 1}};
    rock_.features[radius_] = merge(radii, Scale::ratio);
    rock_.quality.feature_confidences[radius_] = spread_confidence(rock_.features[radius_], Scale::ratio, 0);
    geodb::MapContents contents;
    contents.types = types_;
    contents.landmarks = {rock_};
    contents.crs = crs;
    geodb::write_map(folder_.path() / "map.gpkg", contents, {.empty_tables = empty_tables});
    return open_robot_map((folder_.path() / "map.gpkg").string(), nullptr);
  }

  /// Returns a rock after a drive that found it in `matches` of `expected` scans, with a radius in each.
  localization::SlamLandmark after_drive(std::int64_t matches, std::int64_t expected, double radius) const {
    localization::SlamLandmark l;
    l.at = {5.05, 2};
    l.covariance = Eigen::Matrix2d::Identity() * 0.001;
    l.log_odds = 4;
    l.matches = matches;
    l.expected = expected;
    l.type = types_.id("rock");
    for (int i = 0; i < std::min<std::int64_t>(matches, 100); ++i) {
      localization::KnownFeatures seen;
      seen.value[radius_] = radius + (i % 2 ? 0.1 : -0.1);
      l.feature_samples.push_back(seen);
    }
    return l;
  }

  LockedFolder folder_{std::filesystem::temp_directory_path()};
  const TypeRegistry& types_ = all_types();
  std::size_t radius_ = feature_index(types_[types_.id("rock")], "radius");
  Landmark rock_;
};

TEST_F(SlamUpdateOfARock, ErrorsCommonToAllImagesAreKept) {
  static_cast<void>(make_map());  // sets rock_
  constexpr double common = 0.05;
  const double spread = rock_.features[radius_].variance;
  const auto after = [&] {
    geodb::MapContents contents;
    contents.types = types_;
    contents.landmarks = {rock_};
    geodb::write_map(folder_.path() / "map.gpkg", contents);
    const OpenedMap opened = open_robot_map((folder_.path() / "map.gpkg").string(), nullptr);
    localization::SlamLandmark found = after_drive(10, 10, 1);
    found.key = localization::landmark_key("rock-1");
    found.was_mapped = true;
    return make_slam_update({&found, 1}, opened.map, {}, "drive", 2).changed.at(0);
  };
  const Landmark plain = after();
  rock_.features[radius_].variance = spread / 2 + common;
  const Landmark both = after();
  EXPECT_NEAR(both.quality.feature_confidences[radius_].value(),
              plain.quality.feature_confidences[radius_].value(), 1e-9);
  EXPECT_NEAR(both.features[radius_].variance, plain.features[radius_].variance / 3 + common, 1e-9);
}

// A log of a room of 8 x 6 m, whose walls are 1 m nearer from beam to beam where `roughness` is 1.
localization::RobotLog log_of_room(double roughness) {
  localization::RobotLog log;
  for (int scan = 0; scan < 100; ++scan) {
    localization::LaserScan made;
    made.first_angle = -std::numbers::pi / 2, made.angle_step = std::numbers::pi / 180;
    made.max_range = 20;
    Random random(std::uint64_t(scan), "room");
    for (int i = 0; i <= 180; ++i) {
      const double angle = made.first_angle + i * made.angle_step + 0.01 * scan;
      const double wall = std::min(4 / std::abs(std::cos(angle)), 3 / std::abs(std::sin(angle)));
      made.ranges.push_back(static_cast<float>(wall - roughness * random.uniform(0, 1)));
    }
    log.events.push_back({.t = double(scan), .what = made});
  }
  return log;
}

TEST(ScansOfALog, WithoutAMapWallsAreFoundWhereTheyFillTheScans) {
  const OpenedMap none = make_empty_robot_map();
  EXPECT_EQ(scans_of_log(log_of_room(0), none.map)->find, "walls,wall_lines");
  EXPECT_EQ(scans_of_log(log_of_room(1), none.map)->find, "rocks");
  EXPECT_EQ(scans_of_log({}, none.map)->find, "rocks");
  localization::RobotLog park = log_of_room(0);
  park.shows_stems = true;
  EXPECT_EQ(scans_of_log(park, none.map)->find, "stems");
}

TEST_F(SlamUpdateOfARock, ScansAreOfWhatAMapHolds) {
  EXPECT_FALSE(scans_of_log(log_of_room(0), make_map().map));
}

/// South polar stereographic, at 90 degrees east: x grows to the north, y to the west.
TEST_F(SlamUpdateOfARock, CovariancesAndDirectionsOfAPolarMapAreAlongItsAxes) {
  const Crs polar = Crs::from_text("IAU_2015:30135");
  const auto at = CrsTransform(geographic_crs(polar), polar)(90, -89);
  const OpenedMap opened = make_map(polar, {at.x, at.y, 0}, {"wall"});
  localization::SlamLandmark rock = after_drive(10, 10, 1);
  rock.key = localization::landmark_key("rock-1");
  rock.was_mapped = true;
  rock.at = {0, 0.5};  // east and north of the frame
  rock.covariance = Eigen::Vector2d(0.001, 0.004).asDiagonal();
  const Landmark changed = make_slam_update({&rock, 1}, opened.map, {}, "drive", 2).changed.at(0);
  EXPECT_NEAR(changed.position.xyz.x(), at.x + 0.5, 0.01);
  EXPECT_NEAR(changed.covariance(0, 0), 0.004, 1e-6);
  EXPECT_NEAR(changed.covariance(1, 1), 0.001, 1e-6);

  localization::SlamLandmark wall;
  const TypeRegistry& of_map = opened.map.types();
  wall.type = of_map.id("wall");
  wall.log_odds = 4, wall.matches = 3, wall.expected = 3;
  wall.at = {3, 3};
  wall.covariance = Eigen::Vector2d(0.001, 0.004).asDiagonal();
  const std::size_t direction = feature_index(of_map[*wall.type], "direction");
  localization::KnownFeatures look;
  look.value[direction] = 0.3;  // clockwise from true north, the map's x axis
  wall.feature_samples = {look, look};
  const SlamUpdate update = make_slam_update({&wall, 1}, opened.map, {}, "drive", 2);
  EXPECT_NEAR(update.added.at(0).features[direction].value, 0.3 + std::numbers::pi / 2, 1e-4);
  EXPECT_NEAR(update.evidence.at(0).features[direction].value, 0.3 + std::numbers::pi / 2, 1e-4);
  EXPECT_NEAR(update.added.at(0).covariance(0, 0), 0.004, 1e-5);
}

TEST_F(SlamUpdateOfARock, ADriveCountsAsOneSurvey) {
  const OpenedMap opened = make_map();
  localization::SlamLandmark found = after_drive(400, 500, 1);
  found.key = localization::landmark_key("rock-1");
  found.was_mapped = true;
  Landmark changed = make_slam_update({&found, 1}, opened.map, {}, "drive", 2).changed.at(0);
  EXPECT_EQ(changed.quality.seen, 4);
  EXPECT_EQ(changed.quality.visible, 5);

  localization::SlamLandmark missed = after_drive(0, 500, 1);
  missed.key = found.key;
  missed.was_mapped = true;
  changed = make_slam_update({&missed, 1}, opened.map, {}, "drive", 2).changed.at(0);
  EXPECT_EQ(changed.quality.seen, 3);
  EXPECT_EQ(changed.quality.visible, 5);
}

TEST_F(SlamUpdateOfARock, ADriveIsOneMoreObservationOfAFeature) {
  const OpenedMap opened = make_map();
  localization::SlamLandmark found = after_drive(40, 50, 1.3);
  found.key = localization::landmark_key("rock-1");
  found.was_mapped = true;
  const SlamUpdate update = make_slam_update({&found, 1}, opened.map, {}, "drive", 2);
  const WeightedValue three[] = {{0.93, 1}, {1.07, 1}, {1.3, 1}};
  const FeatureValue expected = merge(three, Scale::ratio);
  const Landmark& changed = update.changed.at(0);
  EXPECT_NEAR(changed.features[radius_].value, expected.value, 1e-9);
  EXPECT_NEAR(changed.features[radius_].variance, expected.variance, 1e-9);
  EXPECT_EQ(changed.features[radius_].observations, 3);
  EXPECT_NEAR(changed.quality.feature_confidences[radius_].value(),
              1 - std::sqrt(expected.variance) / expected.value, 1e-9);
  EXPECT_NEAR(update.evidence.at(0).features[radius_].value, 1.3, 1e-9) << "what the drive saw";
}

TEST_F(SlamUpdateOfARock, ANewLandmarkHasCountsAndQualityOfItsOwn) {
  const OpenedMap opened = make_map();
  localization::SlamLandmark found = after_drive(40, 50, 0.5);
  found.at = {20, 2};
  const SlamUpdate update = make_slam_update({&found, 1}, opened.map, {}, "drive", 2);
  const Landmark& added = update.added.at(0);
  EXPECT_EQ(added.quality.seen, 1);
  EXPECT_EQ(added.quality.visible, 1);
  EXPECT_DOUBLE_EQ(added.confidence, localization::probability_from_log_odds(4));
  const std::optional<double> quality = quality_of(types_[added.type], added);
  ASSERT_TRUE(quality.has_value());
  EXPECT_NEAR(*quality, 1 - 0.1013 / 0.5,
              1e-3);  // 40 radii of 0.4 and 0.6 m: an unbiased deviation of 0.1013
}

}  // namespace
}  // namespace waymark::test
