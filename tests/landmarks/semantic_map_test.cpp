// SPDX-License-Identifier: Apache-2.0
#include "landmarks/semantic_map.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>

#include "landmarks/uid_index.hpp"

namespace waymark::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;

FeatureSpec feature(const std::string& name) {
  return {.name = name, .unit = "m", .summary = {}};
}

TypeRegistry two_types() {
  TypeRegistry types;
  types.add({.name = "rock", .summary = {}, .features = {feature("radius"), feature("height")}});
  types.add({.name = "tree", .summary = {}, .features = {feature("diameter")}});
  return types;
}

struct Made {
  double x = 0, y = 0;
  TypeId type = 0;
  Quality quality = {};
};

SemanticMap map_of(const std::string& crs, const std::vector<Made>& made) {
  std::vector<Landmark> landmarks;
  for (const Made& each : made) {
    Landmark landmark;
    landmark.uid = std::string(1, static_cast<char>('a' + landmarks.size()));
    landmark.type = each.type;
    landmark.position = {{each.x, each.y, 0}};
    landmark.quality = each.quality;
    landmarks.push_back(std::move(landmark));
  }
  return {two_types(), Crs::from_text(crs), std::move(landmarks)};
}

std::vector<std::string> uids(const SemanticMap::LandmarkRefs& found) {
  std::vector<std::string> all;
  for (const Landmark& landmark : found) all.push_back(landmark.uid);
  return all;
}

Point<MapCrs> at(double x, double y) {
  return {{x, y, 0}};
}

TEST(SemanticMap, FindsByName) {
  const SemanticMap map = map_of("local", {{1, 2}, {3, 4}});
  ASSERT_NE(map.find("b"), nullptr);
  EXPECT_EQ(map.find("b")->position.xyz.x(), 3);
  EXPECT_EQ(map.find("z"), nullptr);
}

TEST(SemanticMap, NearIsInMetresNearestFirst) {
  const SemanticMap map = map_of("local", {{0, 30}, {0, 10}, {0, 100}, {20, 0}});
  EXPECT_THAT(uids(map.near(at(0, 0), 30_m)), ElementsAre("b", "d", "a"));
}

TEST(SemanticMap, NearCrossesTheAntimeridian) {
  const SemanticMap map = map_of("EPSG:4326", {{179.99, 0}, {-179.99, 0}, {179, 0}});
  EXPECT_THAT(uids(map.near(at(180, 0), 2000_m)), ElementsAre("a", "b"));
}

TEST(SemanticMap, NearGoesOverThePole) {  // 0.01 degrees of latitude are 1117 m there
  const SemanticMap map = map_of("EPSG:4326", {{0, 89.99}, {180, 89.99}, {0, 89.9}});
  EXPECT_THAT(uids(map.near(at(90, 90), 1200_m)), ElementsAre("a", "b"));
  EXPECT_THAT(uids(map.near(at(0, 89.99), 2300_m)), ElementsAre("a", "b"));
}

TEST(SemanticMap, ProjectedMetresAreNotGroundMetres) {  // Web Mercator at 60 degrees doubles lengths
  const SemanticMap map = map_of("EPSG:3857", {{0, 8399737.89}, {1000, 8399737.89}});
  EXPECT_THAT(uids(map.near(at(0, 8399737.89), 600_m)), ElementsAre("a", "b"));
  EXPECT_THAT(uids(map.near(at(0, 8399737.89), 400_m)), ElementsAre("a"));
}

TEST(SemanticMap, NearAcceptsAPositionInTheMapFrame) {
  const SemanticMap map = map_of("EPSG:32632", {{400000, 5100000}, {400100, 5100000}});
  const Point<MapFrame> place = map.frame().map_frame_from_crs(at(400100, 5100000));
  EXPECT_THAT(uids(map.near(place, 10_m)), ElementsAre("b"));
}

TEST(SemanticMap, BoxesIncludeTheirBorder) {
  const SemanticMap map = map_of("local", {{0, 0}, {5, 5}, {5.1, 5}});
  EXPECT_THAT(uids(map.in_box({0, 0, 5, 5})), ElementsAre("a", "b"));
}

TEST(SemanticMap, BoxesCrossTheAntimeridian) {
  const SemanticMap map = map_of("EPSG:4326", {{-175, 0}, {0, 0}, {175, 0}, {185, 0}, {180, 0}});
  EXPECT_THAT(uids(map.in_box({170, -10, -170, 10})), ElementsAre("a", "c", "d", "e"));
  EXPECT_THAT(uids(map.in_box({170, -10, 190, 10})), ElementsAre("a", "c", "d", "e"));
  EXPECT_THAT(uids(map.in_box({-10, -10, 10, 10})), ElementsAre("b"));
  EXPECT_EQ(map.in_box({-180, -10, 180, 10}).size(), 5u);
  EXPECT_EQ(map.in_box({0, -10, 360, 10}).size(), 5u);
}

TEST(SemanticMap, FiltersByType) {
  const SemanticMap map = map_of("local", {{0, 0, 0}, {1, 0, 1}, {2, 0, 0}});
  EXPECT_THAT(uids(map.select({.type = "rock"})), ElementsAre("a", "c"));
  EXPECT_THAT(uids(map.nearest(at(0, 0), 1, {.type = "tree"})), ElementsAre("b"));
  EXPECT_THAT(map.select({.type = "crater"}), IsEmpty());
}

TEST(SemanticMap, QualityDependsOnTheSensor) {
  const Quality flat{.seen = 1, .visible = 1, .feature_confidences = {0.2, 0.9}};
  const SemanticMap map = map_of("local", {{0, 0, 0, flat}, {1, 0, 0}});
  const SensorProfile sees_height{"tall", "", {{"rock", "height", 1}}};
  EXPECT_THAT(map.select({.min_quality = 0.6}), IsEmpty());
  EXPECT_THAT(uids(map.select({.min_quality = 0.6, .sensor = &sees_height})), ElementsAre("a"));
  EXPECT_EQ(map.select({}).size(), 2u) << "unknown quality passes without a bound";
}

TEST(SemanticMap, NearestAgreesWithTestingEveryLandmark) {
  for (const char* crs : {"EPSG:4326", "local"}) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(-180, 180), y(-90, 90);
    std::vector<Made> made(300);
    for (Made& each : made) each = {x(random), y(random), static_cast<TypeId>(each.x > 0 ? 0 : 1)};
    const SemanticMap map = map_of(crs, made);
    for (int i = 0; i < 20; ++i) {
      const Point<MapCrs> centre = at(x(random), y(random));
      const auto all = map.near(centre, Meters{1e9});
      ASSERT_EQ(all.size(), map.size());
      const auto five = map.nearest(centre, 5);
      ASSERT_EQ(five.size(), 5u);
      for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(&five[k].get(), &all[k].get());
    }
    EXPECT_EQ(map.nearest(at(0, 0), 1000).size(), 300u);
  }
}

TEST(SemanticMap, HasItsOriginAtTheCentroid) {
  EXPECT_EQ(map_of("local", {{0, 0}, {10, 20}}).frame().origin().xyz, Eigen::Vector3d(5, 10, 0));
  EXPECT_NEAR(map_of("EPSG:4326", {{179, 0}, {-179, 0}}).frame().origin().xyz.x(), 180, 1e-9);
}

TEST(SemanticMap, MayBeEmpty) {
  const SemanticMap map = map_of("EPSG:4326", {});
  EXPECT_EQ(map.size(), 0u);
  EXPECT_THAT(map.nearest(at(0, 0), 3), IsEmpty());
  EXPECT_THAT(map.near(at(0, 0), 1e6_m), IsEmpty());
}

const LandmarkType kTop{.name = "mountain_top", .summary = {}, .features = {}};
const LandmarkType kRock{.name = "rock", .summary = {}, .features = {}};

TEST(Uid, BeginsWithTheTypesInitials) {
  const Crs crs = Crs::from_text("EPSG:4326");
  EXPECT_THAT(make_uid(kTop, crs, {{8, 46, 0}}), MatchesRegex("mt-[0-9a-hjkmnp-tv-z]+"));
  EXPECT_THAT(make_uid(kRock, crs, {{8, 46, 0}}), MatchesRegex("ro-[0-9a-hjkmnp-tv-z]+"));
  EXPECT_EQ(make_uid(kRock, crs, {{8, 46, 0}}).size(), 16u);
}

TEST(Uid, NeverChanges) {  // existing maps contain these uids
  EXPECT_EQ(make_uid(kTop, Crs::from_text("EPSG:4326"), {{-70.011, -32.653, 6929}}), "mt-6p5ge7fc9s4mc");
}

TEST(Uid, DependsOnTypeCrsAndPositionAlone) {
  const Crs earth_crs = Crs::from_text("EPSG:4326"), mars_crs = Crs::from_text("IAU_2015:49900");
  const std::string uid = make_uid(kRock, earth_crs, {{8, 46, 0}});
  EXPECT_EQ(make_uid(kRock, earth_crs, {{8, 46, 99}}), uid) << "heights are refined";
  EXPECT_EQ(make_uid(kRock, earth_crs, {{8 + 1e-9, 46, 0}}), uid) << "less than the rounding";
  EXPECT_NE(make_uid(kRock, earth_crs, {{8 + 1e-6, 46, 0}}), uid);
  EXPECT_NE(make_uid(kRock, mars_crs, {{8, 46, 0}}), uid);
  EXPECT_NE(make_uid(kTop, earth_crs, {{8, 46, 0}}).substr(3), uid.substr(3));
}

TEST(Uid, LongitudesAreEqualModuloATurn) {
  const Crs crs = Crs::from_text("IAU_2015:49900");
  EXPECT_EQ(make_uid(kTop, crs, {{350, 10, 0}}), make_uid(kTop, crs, {{-10, 10, 0}}));
  EXPECT_EQ(make_uid(kTop, crs, {{180, 10, 0}}), make_uid(kTop, crs, {{-180, 10, 0}}));
}

TEST(Uid, RoundsToACentimetreOnAPlane) {
  const Crs utm = Crs::from_text("EPSG:32632");
  EXPECT_EQ(make_uid(kTop, utm, {{400000.001, 5e6, 0}}), make_uid(kTop, utm, {{400000, 5e6, 0}}));
  EXPECT_NE(make_uid(kTop, utm, {{400000.02, 5e6, 0}}), make_uid(kTop, utm, {{400000, 5e6, 0}}));
}

TEST(Uid, NeighbouringCellsHaveDifferentUids) {
  const Crs crs = Crs::from_text("EPSG:4326");
  std::set<std::string> uids;
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column)
      uids.insert(make_uid(kTop, crs, {{8 + column / 3600.0, 46 - row / 3600.0, 0}}));
  EXPECT_EQ(uids.size(), 40000u);
}

TEST(AssignUids, NumbersThoseAtOnePosition) {
  TypeRegistry types;
  types.add(kRock);
  std::vector<Landmark> rocks(4);
  rocks[3].position = {{1, 0, 0}};
  assign_uids(types, Crs::local(), rocks);
  EXPECT_EQ(rocks[1].uid, rocks[0].uid + "-2");
  EXPECT_EQ(rocks[2].uid, rocks[0].uid + "-3");
  EXPECT_NE(rocks[3].uid, rocks[0].uid);
}

TEST(UidIndex, FindsTheFirstOfEachUid) {
  std::vector<Landmark> landmarks(1000);
  for (std::size_t i = 0; i < landmarks.size(); ++i) landmarks[i].uid = "tr-" + std::to_string(i % 900);
  const UidIndex all(landmarks);
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 999; i >= 950; --i) some.push_back(i);
  const UidIndex few(landmarks, some), none(landmarks, std::span<const std::uint32_t>{});
  for (std::uint32_t i = 0; i < 900; ++i) {
    const std::string uid = "tr-" + std::to_string(i);
    EXPECT_EQ(all.find(uid), i);
    EXPECT_EQ(few.find(uid), i >= 50 && i < 100 ? std::optional(99 - i) : std::nullopt) << i;
    EXPECT_EQ(none.find(uid), std::nullopt);
  }
  EXPECT_EQ(all.find("tr-900"), std::nullopt);
  EXPECT_EQ(UidIndex(std::span<const Landmark>{}).find(""), std::nullopt);
}

}  // namespace
}  // namespace waymark::test
