// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_query.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geodb/map_store.hpp"
#include "geodb/rtree/search_windows.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "landmarks/sensor_profile.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::HasSubstr;

std::vector<std::string> uids(const std::vector<Landmark>& landmarks) {
  std::vector<std::string> names;
  for (const Landmark& landmark : landmarks) names.push_back(landmark.uid);
  return names;
}
std::vector<std::string> sorted(std::vector<std::string> names) {
  std::ranges::sort(names);
  return names;
}

/// Map file, and its landmarks in memory for the slow twins of queries.
struct Twin {
  explicit Twin(const Scene& scene) : contents(scattered(scene)), map_distance(contents.crs) {
    write_map(folder / "map.gpkg", contents);
    map = std::make_unique<MapStore>(MapStore::open(folder / "map.gpkg"));
  }
  std::vector<std::string> by_definition(const auto& wanted) const {
    std::vector<std::string> names;
    for (const Landmark& landmark : contents.landmarks)
      if (wanted(landmark)) names.push_back(landmark.uid);
    return sorted(names);
  }
  double distance(const Landmark& l, double x, double y) const {
    return map_distance(x, y, l.position.xyz.x(), l.position.xyz.y());
  }

  TemporaryFolder folder;
  MapContents contents;
  MapDistance map_distance;
  std::unique_ptr<MapStore> map;
};

Scene whole_body(const std::string& crs, double west) {
  return {.crs = crs, .min_x = west, .min_y = -90, .max_x = west + 360, .max_y = 90, .landmarks = 3000};
}

struct Place {
  double x, y, radius;
};
// Mid-latitudes, both sides of the antimeridian, the poles and their neighbourhood, circles about a pole, the
// whole body.
const Place kPlaces[] = {{10, 45, 1e6}, {179.9, 0, 8e5}, {-179.9, 60, 1e6}, {540, 10, 1e6},
                         {0, 90, 1e6},  {77, -90, 5e5},  {123, 88, 1e6},    {-20, -85, 2e6},
                         {0, 0, 1.2e7}, {200, 30, 3e5},  {5, 5, 3e7},       {5, 5, 0}};

class OnABody : public ::testing::TestWithParam<Scene> {};

TEST_P(OnABody, RadiusQueriesAgreeWithTheDefinition) {
  const Twin twin(GetParam());
  for (const auto& [x, y, radius] : kPlaces) {
    const auto found = twin.map->query({.near = MapQuery::Near{x, y, Meters{radius}}});
    EXPECT_EQ(sorted(uids(found)), twin.by_definition([&](const Landmark& l) {
      return twin.distance(l, x, y) <= radius;
    })) << x
        << " " << y << " " << radius;
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, [&](const Landmark& l) { return twin.distance(l, x, y); }));
  }
}

TEST_P(OnABody, NearestAgreeWithTheDefinition) {
  const Twin twin(GetParam());
  for (const auto& place : kPlaces) {
    std::vector<Landmark> all = twin.contents.landmarks;
    std::ranges::stable_sort(all, {}, [&](const Landmark& l) { return twin.distance(l, place.x, place.y); });
    all.resize(7);
    EXPECT_EQ(uids(twin.map->query({.nearest = MapQuery::NearestK{place.x, place.y, 7}})), uids(all));
  }
}

TEST_P(OnABody, BoxesMayCrossTheAntimeridian) {
  const Twin twin(GetParam());
  const MapQuery::Box box{170, -30, -160, 40};  // 30 degrees wide
  const auto inside_box = [&](const Landmark& l) {
    const double east = std::fmod(l.position.xyz.x() - 170 + 720, 360);
    return east <= 30 && l.position.xyz.y() >= -30 && l.position.xyz.y() <= 40;
  };
  const auto found = sorted(uids(twin.map->query({.box = box})));
  EXPECT_GT(found.size(), 20u);
  EXPECT_EQ(found, twin.by_definition(inside_box));
}

INSTANTIATE_TEST_SUITE_P(EarthAndMars, OnABody,
                         ::testing::Values(whole_body("EPSG:4326", -180), whole_body("EPSG:4326", 0),
                                           whole_body("IAU_2015:49900", 0),
                                           whole_body("+proj=longlat +a=3396190 +b=3376200", -180)));

TEST(MapQuery, BoxesAndRadiiInThePlaneAgreeWithTheDefinition) {
  const Twin twin({.landmarks = 2000});
  const MapQuery::Box box{420'000, 5'020'000, 440'000, 5'060'000};
  const auto in_box = [&](const Landmark& l) {
    return contains({box}, l.position.xyz.x(), l.position.xyz.y());
  };
  EXPECT_EQ(sorted(uids(twin.map->query({.box = box}))), twin.by_definition(in_box));
  const auto both = twin.map->query({.box = box, .near = MapQuery::Near{430'000, 5'030'000, Meters{9'000}}});
  EXPECT_EQ(sorted(uids(both)), twin.by_definition([&](const Landmark& l) {
    return in_box(l) && twin.distance(l, 430'000, 5'030'000) <= 9'000;
  }));
}

TEST(MapQuery, EdgesOfABoxBelongToItThoughTheIndexIsFloat32) {
  const Twin twin({.crs = "",
                   .min_x = 8'100'000,
                   .min_y = 8'100'000,
                   .max_x = 8'100'010,
                   .max_y = 8'100'010,
                   .landmarks = 300});
  for (const Landmark& landmark : twin.contents.landmarks) {
    const double x = landmark.position.xyz.x(), y = landmark.position.xyz.y();
    EXPECT_EQ(uids(twin.map->query({.box = MapQuery::Box{x, y, x, y}})), std::vector{landmark.uid});
  }
}

TEST(MapQuery, FeatureRangesLeaveOutTheUnknown) {
  const Twin twin({});
  const auto found =
      twin.map->query({.features = {{.feature = "diameter", .min_value = 0.2, .max_value = 0.3},
                                    {.feature = "height", .min_value = 5}}});
  EXPECT_GT(found.size(), 20u);
  EXPECT_EQ(sorted(uids(found)), twin.by_definition([](const Landmark& l) {
    return l.features[1].known() && l.features[1].value >= 0.2 && l.features[1].value <= 0.3 &&
           l.features[0].value >= 5;
  }));
}

TEST(MapQuery, LargestFirstGivesTheLargest) {
  const Twin twin({.landmarks = 5000});
  std::vector<Landmark> all = twin.contents.landmarks;
  std::ranges::sort(all, std::greater{}, [](const Landmark& l) { return l.features[0].value; });
  all.resize(25);
  EXPECT_EQ(uids(twin.map->query({.largest_first = "height", .limit = 25})), uids(all));
  EXPECT_EQ(twin.map->query({.limit = 10}).size(), 10u);
  EXPECT_TRUE(twin.map->query({.limit = 0}).empty());
}

// Landmarks of a type without the feature rank last, in the order of the map; their table is not read whole.
TEST(MapQuery, ATypeWithoutTheFeatureComesLast) {
  MapContents contents = scattered({.landmarks = 60'000, .with_evidence = 0});
  LandmarkType post = lamp_post();
  post.name = "bollard", post.label_feature = post.size_feature = "diameter";
  post.features.erase(post.features.begin());  // no height
  const TypeId bollard = contents.types.add(post);
  for (std::size_t i = 0; i < contents.landmarks.size(); ++i) {
    Landmark& l = contents.landmarks[i];
    if (i % 20 == 3) continue;
    l.type = bollard;
    l.features.erase(l.features.begin());
    l.quality.feature_confidences.erase(l.quality.feature_confidences.begin());
  }
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", contents);
  const MapStore map = MapStore::open(folder / "map.gpkg");
  const std::vector<std::string> all = uids(map.query({.largest_first = "height", .limit = 60'000}));
  ASSERT_EQ(all.size(), 60'000u);
  std::vector<Landmark> posts;
  for (const Landmark& l : contents.landmarks)
    if (l.type != bollard) posts.push_back(l);
  std::ranges::stable_sort(posts, std::greater{}, [](const Landmark& l) { return l.features[0].value; });
  const std::vector<std::string> expected = uids(posts);
  for (const std::size_t limit : {std::size_t{1}, posts.size(), posts.size() + 1, posts.size() + 500}) {
    const auto found =
        uids(map.query({.largest_first = "height", .limit = static_cast<std::int64_t>(limit)}));
    EXPECT_EQ(found, std::vector<std::string>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(limit)));
    const std::size_t shown = std::min(limit, posts.size());
    EXPECT_TRUE(
        std::equal(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(shown), found.begin()));
  }
}

// The most common value of all: an index of it would be one of the whole map, and a scan may stop early.
TEST(MapQuery, ManyEqualLargestValuesNeedNoIndexOfAll) {
  MapContents contents = scattered({.landmarks = 60'000, .with_evidence = 0});
  for (std::size_t i = 0; i < contents.landmarks.size(); ++i)
    contents.landmarks[i].confidence = i % 100 == 7 ? 1 : i % 3 == 0 ? 0.5 : 0.9;
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", contents);
  EXPECT_EQ(query_text(folder / "map.gpkg",
                       "SELECT count(*) FROM lamp_post INDEXED BY lamp_post_confidence_largest "
                       "WHERE confidence > 0.90000000000000002"),
            "600");
  write_map(folder / "scan.gpkg", contents);
  execute_sql(folder / "scan.gpkg", "DROP INDEX lamp_post_confidence_largest");
  const MapStore indexed = MapStore::open(folder / "map.gpkg"),
                 scanned = MapStore::open(folder / "scan.gpkg");
  for (const std::int64_t limit : {0, 1, 599, 600, 601, 9'000, 50'000}) {
    const MapQuery query{.largest_first = "confidence", .limit = limit};
    EXPECT_EQ(uids(indexed.query(query)), uids(scanned.query(query))) << limit;
  }
}

SensorProfile sensor_of_heights() {
  return {.name = "heights", .summary = "", .weights = {{"lamp_post", "height", 1}}};
}

/// Removes the indexes of the largest values: every query is a scan.
void drop_largest_indexes(const std::filesystem::path& map) {
  std::string script = query_text(
      map,
      "SELECT group_concat('DROP INDEX \"' || name || '\"', '; ') FROM sqlite_schema WHERE name LIKE "
      "'%_largest'");
  ASSERT_NE(script, "");
  execute_sql(map, script);
}

// Maps of 50,000 landmarks and more have an index of the largest values. Rounded heights make many ties.
TEST(MapQuery, TheIndexOfTheLargestGivesWhatAScanGives) {
  MapContents contents = scattered({.landmarks = 60'000, .with_evidence = 0});
  for (Landmark& l : contents.landmarks) {
    l.features[0].value = std::round(100 * l.features[0].value) / 100;
    l.confidence = std::round(10 * l.features[1].value) / 10;
    if (std::isnan(l.confidence)) l.confidence = 0;
    l.quality.seen = static_cast<int>(100 * l.features[0].value) % 10;
    l.quality.visible = 10;
  }
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", contents);
  EXPECT_EQ(query_text(folder / "map.gpkg",
                       "SELECT count(*) FROM sqlite_schema WHERE name IN ('lamp_post_height_largest', "
                       "'lamp_post_diameter_largest', 'lamp_post_quality_largest', "
                       "'lamp_post_confidence_largest')"),
            "4");
  write_map(folder / "scan.gpkg", contents);
  drop_largest_indexes(folder / "scan.gpkg");
  const MapStore indexed = MapStore::open(folder / "map.gpkg"),
                 scanned = MapStore::open(folder / "scan.gpkg");
  for (const std::string feature : {"height", "diameter", "quality", "confidence"})
    for (const std::int64_t limit : {0, 1, 7, 300, 9'000, 20'000})
      for (const double confidence : {0.0, 0.4}) {
        const MapQuery query{.min_confidence = confidence, .largest_first = feature, .limit = limit};
        EXPECT_EQ(uids(indexed.query(query)), uids(scanned.query(query))) << feature << ' ' << limit;
      }
  const MapQuery tall{
      .features = {{.feature = "height", .max_value = 5}}, .largest_first = "height", .limit = 3};
  EXPECT_EQ(uids(indexed.query(tall)), uids(scanned.query(tall)));  // none of the largest: a scan after all
  EXPECT_THAT(validate_map(folder / "map.gpkg"), ::testing::IsEmpty());
}

// Few have a quality, none a deviation, nearly all are seen once: what no index held was a scan of the map.
TEST(MapQuery, EveryNumberOfALargeMapHasAnIndexOfItsLargest) {
  MapContents contents = scattered({.landmarks = 60'000, .with_evidence = 0});
  for (std::size_t i = 0; i < contents.landmarks.size(); ++i) {
    Landmark& l = contents.landmarks[i];
    const bool assessed = i % 600 == 0;
    l.features[0].variance = assessed ? 0.01 * static_cast<double>(i % 7) : 0;
    l.quality = assessed
                    ? Quality{.seen = static_cast<int>(i / 600 % 5), .visible = 5, .feature_confidences = {}}
                    : Quality{.seen = 1, .visible = 1, .feature_confidences = {}};
  }
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", contents);
  write_map(folder / "scan.gpkg", contents);
  drop_largest_indexes(folder / "scan.gpkg");
  const MapStore indexed = MapStore::open(folder / "map.gpkg"),
                 scanned = MapStore::open(folder / "scan.gpkg");
  const SensorProfile heights = sensor_of_heights();
  for (const char* column : {"quality", "q_multiplicity", "seen", "visible", "observations", "height_sd",
                             "diameter_q", "var_x", "var_z", "fixtures", "diameter"}) {
    const std::string name(column);
    EXPECT_THAT(query_text(folder / "map.gpkg",
                           "SELECT sql FROM sqlite_schema WHERE name = 'lamp_post_" + name + "_largest'"),
                ::testing::HasSubstr("CREATE INDEX"))
        << name;
    for (const std::int64_t limit : {1, 7, 101, 5'000})
      for (const double min_height : {0.0, 5.0})
        for (const SensorProfile* sensor : {static_cast<const SensorProfile*>(nullptr), &heights}) {
          const MapQuery query{.features = {{.feature = "height", .min_value = min_height}},
                               .sensor = sensor,
                               .largest_first = name,
                               .limit = limit};
          EXPECT_EQ(uids(indexed.query(query)), uids(scanned.query(query))) << name << ' ' << limit;
        }
  }
}

// A sensor's quality differs from the stored one in order.
TEST(MapQuery, TheLargestQualityOfASensorIsNotTheStoredOne) {
  MapContents contents = scattered({.landmarks = 60'000, .with_evidence = 0});
  for (std::size_t i = 0; i < contents.landmarks.size(); ++i) {
    const double agreement = static_cast<double>(i * 7919 % 60'000) / 60'000;
    contents.landmarks[i].quality = {
        .seen = 4, .visible = 5, .feature_confidences = {agreement, 1 - agreement * agreement}};
  }
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", contents);
  write_map(folder / "scan.gpkg", contents);
  drop_largest_indexes(folder / "scan.gpkg");
  const SensorProfile heights = sensor_of_heights();
  const MapQuery query{.sensor = &heights, .largest_first = "quality", .limit = 5};
  EXPECT_EQ(uids(MapStore::open(folder / "map.gpkg").query(query)),
            uids(MapStore::open(folder / "scan.gpkg").query(query)));
}

TEST(MapQuery, EveryNumberCanBeQueried) {
  const Twin twin({});  // seen 3 of 4, confidence 0.8, quality 0.675, fixtures 0 to 3
  EXPECT_EQ(twin.map->query({.features = {{.feature = "quality", .min_value = 0.67}}}).size(), 1000u);
  EXPECT_TRUE(twin.map->query({.features = {{.feature = "quality", .min_value = 0.68}}}).empty());
  EXPECT_EQ(twin.map->query({.features = {{.feature = "seen", .min_value = 3, .max_value = 3}}}).size(),
            1000u);
  EXPECT_TRUE(twin.map->query({.features = {{.feature = "confidence", .max_value = 0.79}}}).empty());
  EXPECT_EQ(twin.map->query({.features = {{.feature = "fixtures", .min_value = 2}}}).size(), 500u);
  EXPECT_EQ(twin.map->query({.min_confidence = 0.8}).size(), 1000u);
  EXPECT_TRUE(twin.map->query({.min_confidence = 0.81}).empty());
  EXPECT_EQ(twin.map->query({.largest_first = "fixtures", .limit = 1})[0].attributes[1],
            AttributeValue{std::int64_t{3}});
}

TEST(MapQuery, QualityDependsOnTheSensor) {
  const Twin twin({});  // q_# = 3/4, q of height 0.9, of diameter unknown
  EXPECT_EQ(twin.map->query({.min_quality = 0.67}).size(), 1000u);
  EXPECT_TRUE(twin.map->query({.min_quality = 0.68}).empty());
  const SensorProfile blind{.name = "blind", .summary = "", .weights = {{"lamp_post", "diameter", 1}}};
  EXPECT_EQ(twin.map->query({.min_quality = 0.74, .sensor = &blind}).size(), 1000u);
}

std::string message(const MapStore& map, const MapQuery& query) {
  try {
    map.query(query);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "no error";
}

TEST(MapQuery, TypingErrorsAreErrors) {
  const Twin twin({});
  EXPECT_THAT(message(*twin.map, {.types = {"lamp_pots"}}), HasSubstr("did you mean 'lamp_post'?"));
  EXPECT_THAT(message(*twin.map, {.types = {"x"}}), HasSubstr("it has: lamp_post"));
  EXPECT_THAT(message(*twin.map, {.features = {{.feature = "heigth"}}}), HasSubstr("did you mean 'height'?"));
  EXPECT_THAT(message(*twin.map, {.largest_first = "prominence"}), HasSubstr("has a feature 'prominence'"));
  EXPECT_THAT(message(*twin.map, {.near = MapQuery::Near{}, .nearest = MapQuery::NearestK{}}),
              HasSubstr("cannot be combined"));
}

}  // namespace
}  // namespace waymark::test
