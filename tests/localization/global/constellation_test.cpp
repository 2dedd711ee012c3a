// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "core/text_file.hpp"
#include "localization/global/chance_matches.hpp"
#include "localization/global/constellation.hpp"
#include "tests/localization/made_look.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

struct Stars {
  std::vector<MapLandmark> map;
  std::vector<LandmarkPosition> positions;
};

Stars on_plane(std::vector<MapLandmark> map) {
  Stars all{std::move(map), {}};
  for (const MapLandmark& l : all.map)
    all.positions.push_back({{l.at.x(), l.at.y(), 0}, Eigen::Vector3d::UnitZ()});
  return all;
}

Stars strewn_rocks(std::size_t count, double side, std::uint64_t seed) {
  auto map = scatter_landmarks(count, side, seed, 0.05);
  Random random(seed, "radius");
  for (MapLandmark& l : map) l.features.value[0] = random.log_uniform(0.2, 1);
  return on_plane(std::move(map));
}

/// Simulates sightings at `tries` positions near landmarks, each once as seen and once with random bearings.
Tally tally(const Stars& stars, const ConstellationIndex& index, const SensorModel& how, int tries,
            std::uint64_t seed, std::size_t least = 6) {
  Tally t;
  Random random(seed, "places");
  while (t.tries < tries) {
    const LandmarkPosition& near = stars.positions[random.uniform_index(stars.positions.size())];
    TangentPlane plane{.origin = near.at};
    if (near.up.z() < 0.9999999) {
      plane.east = Eigen::Vector3d::UnitZ().cross(near.up).normalized();
      plane.north = near.up.cross(plane.east);
    }
    const Pose2 robot{random.normal() * how.reach / 5, random.normal() * how.reach / 5,
                      random.uniform(-3.1, 3.1)};
    const SimulatedSightings seen = look(stars.map, stars.positions, plane, robot, how, random);
    if (seen.truth.size() < least) continue;
    ++t.tries;
    const auto begun = std::chrono::steady_clock::now();
    const ConstellationAnswer answer = index.find(seen.set);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    t.seconds += took;
    t.slowest = std::max(t.slowest, took);
    if (!answer.fix) {
      ++t.unknown;
    } else {
      const Eigen::Vector3d at = answer.fix->plane.point(answer.fix->plane_pose.pose.at());
      const Eigen::Vector3d off = at - plane.point(robot.at());
      const double sideways = std::hypot(plane.east.dot(off), plane.north.dot(off));
      ++(sideways < 0.1 * how.reach + 5 * how.range_sd ? t.right : t.wrong);
    }
    t.invented += index.find(scramble_bearings(seen.set, random)).fix.has_value();
  }
  return t;
}

void report(const char* what, const Stars& stars, const ConstellationIndex& index, const Tally& t) {
  std::cout << what << ": " << stars.map.size() << " landmarks, " << index.triangles() << " triangles, "
            << static_cast<double>(index.bytes()) / 1e6 << " MB; of " << t.tries << " looks " << t.right
            << " right, " << t.wrong << " wrong, " << t.unknown
            << " unknown; scrambled looks placed: " << t.invented << "; " << 1e3 * t.seconds / t.tries
            << " ms each, slowest " << 1e3 * t.slowest << " ms\n";
}

TEST(PointCells, FindTheSameAsLookingAtAll) {
  Random random(1);
  for (const bool flat : {true, false}) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 500; ++i)
      points.emplace_back(random.uniform(-50, 50), random.uniform(-50, 50),
                          flat ? 0 : random.uniform(-50, 50));
    const PointCells cells(points);
    for (const double radius : {0.0, 1.0, 7.0, 40.0, 300.0}) {
      const Eigen::Vector3d centre(random.uniform(-60, 60), random.uniform(-60, 60), 0);
      std::vector<std::uint32_t> found, expected;
      cells.near(centre, radius, [&](std::uint32_t i, double) { found.push_back(i); });
      for (std::uint32_t i = 0; i < points.size(); ++i)
        if ((points[i] - centre).norm() <= radius) expected.push_back(i);
      EXPECT_THAT(found, ::testing::UnorderedElementsAreArray(expected)) << radius;
    }
  }
}

TEST(ChanceMatches, EqualSightingsFollowTheBinomial) {
  // All matches in the middle shell of a gate of 9: twice the tail of matches and of better shells.
  std::vector<ChanceMatch> sightings(4, {.probability = 0.1, .is_matched = false, .squares = 0});
  EXPECT_EQ(chance_of_matches(sightings, 9), 1);
  for (ChanceMatch& s : sightings) s.is_matched = true;
  // Four matches, all in the innermost of six shells.
  EXPECT_NEAR(chance_of_matches(sightings, 9), 2 * std::pow(0.1 / 6, 4), 1e-12);
  // In the outermost shell every match counts: four of four.
  for (ChanceMatch& s : sightings) s.squares = 8.9;
  EXPECT_GE(chance_of_matches(sightings, 9), 0.99 * std::pow(0.1, 4));
  EXPECT_GT(chance_of_matches(sightings, 9), 20 * std::pow(0.1 / 6, 4));
}

TEST(ChanceMatches, IsMoreThanTheFractionOfDrawsThatMatchAsWell) {
  // Draws by chance: the fraction with a value below 0.05 is at most 0.05, up to three deviations.
  Random random(5, "chance");
  int below = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    std::vector<ChanceMatch> sightings;
    for (int k = 0; k < 12; ++k) {
      const double p = random.log_uniform(0.003, 0.3);
      sightings.push_back({p, random.bernoulli(p), random.uniform(0, 9)});
    }
    below += chance_of_matches(sightings, 9) < 0.05;
  }
  EXPECT_LT(below, kDraws * 0.05 + 3 * std::sqrt(kDraws * 0.05));
  EXPECT_GT(below, 0);
}

// Of two places that are alike, the map lacks landmarks of the one where the robot is, or of the other.
TEST(Constellation, PlacesThatTheMapRepeatsAreUnknown) {
  Stars real = strewn_rocks(300, 120, 3);
  const std::size_t half = real.map.size();
  for (std::size_t i = 0; i < half; ++i) {
    MapLandmark twin = real.map[i];
    twin.at = Eigen::Vector2d(400, 30) - twin.at;
    real.map.push_back(twin);
  }
  real = on_plane(std::move(real.map));
  Random random(5, "repeated");
  std::vector<MapLandmark> mapped;
  std::ranges::copy_if(real.map, std::back_inserter(mapped),
                       [&](const MapLandmark&) { return !random.bernoulli(0.1); });
  const ConstellationIndex index(mapped, FeatureScales{});
  const Tally t = tally(real, index, {}, 200, 5, 8);
  report("repeated places, a tenth unmapped", real, index, t);
  EXPECT_LE(t.wrong, 1);
  EXPECT_EQ(t.invented, 0);
}

// Half of what is seen is unmapped. Of two places that are alike, the map lacks a quarter of the rest at the
// one where the robot is: no more than it lacks anyhow.
TEST(Constellation, TheMapMayLackMoreOfOneOfTwoPlacesThatAreAlike) {
  const Stars real = strewn_rocks(40, 40, 11);
  std::vector<MapLandmark> mapped;
  for (std::size_t i = 0; i < 20; ++i) {
    MapLandmark twin = real.map[i];
    twin.key += 1000;
    twin.at.x() += 200;
    mapped.push_back(twin);
    if (i % 4 != 0) mapped.push_back(real.map[i]);
  }
  const ConstellationIndex index(mapped, {});
  Random random(2);
  const SensorModel how{.reach = 40, .detected = 1, .clutter = 0};
  const auto seen = look(real.map, real.positions, {}, {}, how, random);
  const ConstellationAnswer answer = index.find(seen.set);
  EXPECT_FALSE(answer.fix);
  EXPECT_EQ(answer.reason, "the map has two such places");
  ASSERT_GE(answer.candidates.size(), 2u);
  EXPECT_GE(answer.candidates[0].matched, answer.candidates[1].matched + 5);
  ConstellationOptions started;  // odometry judges the answers of a robot that had a pose
  started.had_pose = true;
  EXPECT_TRUE(ConstellationIndex(mapped, {}, started).find(seen.set).fix);
}

// Terrain hides most rocks of a rover's map, so few of its sightings are neighbours in the map.
TEST(Constellation, FindsRocksOfWhichOneInFiveIsSeen) {
  const Stars stars = strewn_rocks(4700, 250, 7);
  const ConstellationIndex index(stars.map, {});
  const SensorModel how{.reach = 25, .range_sd = 0.15, .feature_sd = 0.15, .detected = 0.2};
  const Tally t = tally(stars, index, how, 100, 1, 18);
  report("rocks, one in five seen", stars, index, t);
  EXPECT_GE(t.right, 96);
  EXPECT_EQ(t.wrong, 0);
  EXPECT_EQ(t.invented, 0);
}

TEST(Constellation, FindsRocksAnywhereInAMap) {
  const Stars stars = strewn_rocks(5000, 500, 3);
  const ConstellationIndex index(stars.map, {});
  const Tally t = tally(stars, index, {.reach = 15}, 100, 1);
  report("rocks", stars, index, t);
  EXPECT_GE(t.right, 90);
  EXPECT_EQ(t.wrong, 0);
  EXPECT_EQ(t.invented, 0);
}

// Three for each true one, near it: in the index they would take the places of true neighbours.
// Walls of a map are lines and no part of a constellation: the search is the same with and without them.
TEST(Constellation, LinesOfTheMapAreLeftOut) {
  const Stars stars = strewn_rocks(300, 120, 4);
  std::vector<MapLandmark> with_walls = stars.map;
  Random random(9, "walls");
  for (int k = 0; k < 200; ++k) {
    MapLandmark wall = stars.map[static_cast<std::size_t>(k)];
    wall.at = {random.uniform(-60, 60), random.uniform(-60, 60)};
    wall.normal = {0, 1};
    wall.half_length = 10;
    wall.covariance = Eigen::Vector2d(33, 0.01).asDiagonal();
    with_walls.push_back(wall);
  }
  const ConstellationIndex plain(stars.map, {}), mixed(with_walls, {});
  EXPECT_EQ(mixed.size(), plain.size());
  const Tally a = tally(stars, plain, {.reach = 15}, 30, 1), b = tally(stars, mixed, {.reach = 15}, 30, 1);
  EXPECT_EQ(a.right, b.right);
  EXPECT_EQ(a.wrong, b.wrong);
  EXPECT_GT(a.right, 20);
}

TEST(Constellation, DoubtfulLandmarksAreNoWorseThanNone) {
  const Stars stars = strewn_rocks(600, 200, 3);
  std::vector<MapLandmark> with_false = stars.map;
  Random random(8, "false");
  for (const MapLandmark& l : stars.map)
    for (int i = 0; i < 3; ++i) {
      MapLandmark false_one = l;
      false_one.key = with_false.size() + 1000000;
      false_one.at += Eigen::Vector2d(random.uniform(-5, 5), random.uniform(-5, 5));
      false_one.quality = random.uniform(0.05, 0.3);
      with_false.push_back(false_one);
    }
  const ConstellationIndex removed(stars.map, {}), with(with_false, {});
  const Tally expected = tally(stars, removed, {.reach = 15}, 60, 1);
  const Tally found = tally(stars, with, {.reach = 15}, 60, 1);
  EXPECT_EQ(found.right, expected.right);
  EXPECT_EQ(found.wrong, 0);
  EXPECT_GE(expected.right, 50);
  ConstellationOptions unaware;
  unaware.identification.quality_floor = 1;
  EXPECT_LT(tally(stars, ConstellationIndex(with_false, {}, unaware), {.reach = 15}, 60, 1).right,
            expected.right - 5);
  // Where nothing is more likely than not, everything is searched.
  for (MapLandmark& l : with_false) l.quality = 0.3;
  EXPECT_EQ(ConstellationIndex(with_false, {}).size(), with_false.size());
}

TEST(Constellation, WithoutFeaturesMoreSightingsAreNeededButNoneIsWrong) {
  const Stars stars = on_plane(scatter_landmarks(5000, 500, 5, 0.05));
  const ConstellationIndex index(stars.map, {});
  const Tally t = tally(stars, index, {.reach = 20}, 60, 2, 10);
  report("bare points", stars, index, t);
  EXPECT_GE(t.right, 48);
  EXPECT_EQ(t.wrong, 0);
  EXPECT_EQ(t.invented, 0);
}

TEST(Constellation, PoseAndCovarianceAreThoseOfTheRobot) {
  const Stars stars = strewn_rocks(2000, 300, 7);
  const ConstellationIndex index(stars.map, {});
  Random random(9);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 120; ++i) {
    const Pose2 robot{random.uniform(-120, 120), random.uniform(-120, 120), random.uniform(-3, 3)};
    // The map's errors are part of the covariance: the robot sees the landmarks where they really are.
    auto real = stars;
    for (auto& p : real.positions) p.at += Eigen::Vector3d(0.05 * random.normal(), 0.05 * random.normal(), 0);
    const SimulatedSightings seen =
        look(real.map, real.positions, {}, robot, {.reach = 15, .clutter = 0}, random);
    const auto answer = index.find(seen.set);
    if (!answer.fix) continue;
    sum += nees(answer.fix->pose(), robot);
    ++count;
    for (std::size_t k = 0; k < seen.truth.size(); ++k) {
      const auto landmark = answer.fix->landmarks[k];
      EXPECT_TRUE(!landmark || static_cast<int>(*landmark) == seen.truth[k]) << k;
    }
  }
  ASSERT_GT(count, 90);
  EXPECT_NEAR(sum / (3 * count), 1, 0.25);  // 360 degrees of freedom: sd 0.075; linearised at 15 m
}

TEST(Constellation, TheCheckOfAPoseAgreesWithTheSearch) {
  const Stars stars = strewn_rocks(5000, 500, 3);
  const ConstellationIndex index(stars.map, {});
  Random random(21);
  int found = 0, elsewhere = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose2 robot{random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-3, 3)};
    const SimulatedSightings seen = look(stars.map, stars.positions, {}, robot, {.reach = 15}, random);
    const auto answer = index.find(seen.set);
    if (!answer.fix) continue;
    const auto checked = index.check(seen.set, robot * Pose2{0.2, -0.1, 0.01});
    ASSERT_TRUE(checked) << i;
    EXPECT_EQ(checked->landmarks, answer.fix->landmarks);
    EXPECT_LT((checked->pose().pose.vector() - answer.fix->pose().pose.vector()).norm(), 1e-6);
    ++found;
    elsewhere += index.check(seen.set, robot * Pose2{20, 0, 1}).has_value();
    elsewhere += index.check(scramble_bearings(seen.set, random), robot).has_value();
  }
  EXPECT_GE(found, 30);
  EXPECT_EQ(elsewhere, 0);
}

TEST(Constellation, MirrorImagesAreRejected) {
  // A map and a look at its mirror image: all lengths are right, but it turns the other way.
  Stars stars = strewn_rocks(40, 40, 11);
  const ConstellationIndex index(stars.map, {});
  Random random(1);
  Stars mirrored = stars;
  for (auto& p : mirrored.positions) p.at.x() = -p.at.x();
  const auto seen =
      look(mirrored.map, mirrored.positions, {}, {}, {.reach = 12, .detected = 1, .clutter = 0}, random);
  ASSERT_GT(seen.truth.size(), 6u);
  EXPECT_FALSE(index.find(seen.set).fix);
}

TEST(Constellation, TwoEqualPlacesAreUnknown) {
  Stars stars = strewn_rocks(12, 20, 13);
  const auto once = stars.map;
  for (MapLandmark l : once) {
    l.key += 1000;
    l.at.x() += 100;
    stars.map.push_back(l);
  }
  stars = on_plane(stars.map);
  const ConstellationIndex index(stars.map, {});
  Random random(2);
  const auto seen =
      look(stars.map, stars.positions, {}, {}, {.reach = 14, .detected = 1, .clutter = 0}, random);
  const auto answer = index.find(seen.set);
  EXPECT_FALSE(answer.fix);
  EXPECT_EQ(answer.reason, "two poses fit alike");
  ASSERT_GE(answer.candidates.size(), 2u);
  EXPECT_NEAR(std::abs(answer.candidates[0].pose().pose.x - answer.candidates[1].pose().pose.x), 100, 1);
}

TEST(Constellation, TwoNamesAreEnough) {
  const Stars stars = strewn_rocks(500, 100, 17);
  const ConstellationIndex index(stars.map, {});
  Random random(3);
  auto seen = look(stars.map, stars.positions, {}, {3, 4, 0.5}, {.reach = 12, .clutter = 0}, random);
  ASSERT_GE(seen.truth.size(), 2u);
  seen.set.sightings.resize(2);
  for (std::size_t i = 0; i < 2; ++i)
    seen.set.sightings[i].identity = stars.map[static_cast<std::size_t>(seen.truth[i])].key;
  const auto answer = index.find(seen.set);
  ASSERT_TRUE(answer.fix) << answer.reason;
  EXPECT_LT((answer.fix->pose().pose.at() - Eigen::Vector2d(3, 4)).norm(), 1);
}

// Only the nearest sightings are searched: those of types that the map lacks are not among them.
TEST(Constellation, SightingsOfOtherTypesDoNotCrowdOutThoseOfTheMap) {
  const Stars stars = strewn_rocks(500, 100, 17);
  const ConstellationIndex index(stars.map, {});
  Random random(3);
  auto seen = look(stars.map, stars.positions, {}, {3, 4, 0.5}, {.reach = 15, .clutter = 0}, random);
  ASSERT_TRUE(index.find(seen.set).fix);
  for (int i = 0; i < 60; ++i) {
    SeenLandmark tree = seen.set.sightings[0];
    tree.type = static_cast<TypeId>(*seen.set.sightings[0].type + 1);
    tree.range = random.uniform(0.5, 3), tree.bearing = random.uniform(-3, 3);
    seen.set.sightings.push_back(tree);
  }
  const auto answer = index.find(seen.set);
  ASSERT_TRUE(answer.fix) << answer.reason;
  EXPECT_LT((answer.fix->pose().pose.at() - Eigen::Vector2d(3, 4)).norm(), 1);
  for (SeenLandmark& s : seen.set.sightings) {  // rocks or trees, trees or something else
    const TypeId type = *s.type;
    s.possible_types = {{type, s.features}, {static_cast<TypeId>(type + 1), {}}};
    s.type = {}, s.features = {};
  }
  ASSERT_TRUE(index.find(seen.set).fix);
}

TEST(Constellation, NothingToGoByHasAReason) {
  const Stars stars = strewn_rocks(500, 100, 19);
  const ConstellationIndex index(stars.map, {}), none(std::vector<MapLandmark>{}, {});
  EXPECT_EQ(none.find({}).reason, "the map is empty");
  EXPECT_EQ(index.find({}).reason, "too few sightings with range");
  SightingSet bad;
  for (int i = 0; i < 6; ++i) {
    SeenLandmark s;
    s.bearing = 0;
    s.range = i % 2 ? NAN : -1;
    bad.sightings.push_back(s);
    s.range = {};  // a bearing alone
    bad.sightings.push_back(s);
  }
  EXPECT_EQ(index.find(bad).reason, "too few sightings with range");
}

const std::filesystem::path kShared = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data";

std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& file) {
  std::istringstream in(read_text(file, "the table"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

TEST(Constellation, CratersOfTheWholeMoon) {
  const auto folder = kShared / "craters/catalogues";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  constexpr double kRadius = 1737.4e3;
  Stars stars;
  const auto add = [&](double lon, double lat, double km) {
    MapLandmark l;
    l.key = stars.map.size() + 1;
    l.covariance = Eigen::Matrix2d::Identity() * 300 * 300;
    l.features.value[0] = km * 500;
    const double a = lon * std::numbers::pi / 180, b = lat * std::numbers::pi / 180;
    const Eigen::Vector3d up(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
    stars.map.push_back(l);
    stars.positions.push_back({kRadius * up, up});
  };
  for (const auto& row : rows_of(folder / "HeadCraters.csv"))
    if (row.size() == 3 && row[0] != "Lon") add(std::stod(row[0]), std::stod(row[1]), std::stod(row[2]));
  for (const auto& row : rows_of(folder / "LROCCraters.csv"))
    if (row.size() == 6 && !row[0].empty()) add(std::stod(row[3]), std::stod(row[4]), std::stod(row[2]));
  ASSERT_GT(stars.map.size(), 20000u);
  const ConstellationIndex index(stars.map, stars.positions, {});
  const SensorModel how{.reach = 120e3, .range_sd = 300, .range_sd_per_metre = 0.005, .bearing_sd = 0.005};
  const Tally t = tally(stars, index, how, 60, 1);
  report("craters of the Moon", stars, index, t);
  EXPECT_GE(t.right, 54);
  EXPECT_EQ(t.wrong, 0);
  EXPECT_EQ(t.invented, 0);
}

TEST(Constellation, TreesOfMountRainier) {
  const auto file = kShared / "forest/mount_rainier/mount_rainier_tree_mapping.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
  // Stands of a hectare, side by side; the last survey of each tree.
  std::map<std::string, int> stands;
  std::map<std::string, MapLandmark> trees;
  for (const auto& row : rows_of(file)) {
    if (row.size() != 8 || row[0] == "tree_id") continue;
    try {
      const int stand = stands.try_emplace(row[1], static_cast<int>(stands.size())).first->second;
      MapLandmark l;
      l.key = std::hash<std::string>{}(row[0]);
      l.at = {std::stod(row[6]) + 300 * (stand % 6), std::stod(row[7]) + 300 * (stand / 6)};
      l.covariance = Eigen::Matrix2d::Identity() * 0.1 * 0.1;
      l.features.value[0] = std::stod(row[5]) / 100;
      trees[row[0]] = l;
    } catch (const std::invalid_argument&) {
      // a cell without a number
    }
  }
  std::vector<MapLandmark> map;
  for (const auto& [id, tree] : trees) map.push_back(tree);
  ASSERT_GT(map.size(), 1000u);
  const Stars stars = on_plane(std::move(map));
  const ConstellationIndex index(stars.map, {});
  const Tally t = tally(stars, index, {.reach = 12, .range_sd = 0.05, .bearing_sd = 0.01}, 80, 1);
  report("trees of Mount Rainier", stars, index, t);
  EXPECT_GE(t.right, 64);
  EXPECT_EQ(t.wrong, 0);
  EXPECT_EQ(t.invented, 0);
}

}  // namespace
}  // namespace waymark::test
