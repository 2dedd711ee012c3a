// SPDX-License-Identifier: Apache-2.0
// Landmarks of whole web maps: every tile is decoded by a reader of its own and compared with the map,
// landmark by landmark.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "exporters/vector/export_columns.hpp"
#include "geodb/map_store.hpp"
#include "tests/support/slow_pmtiles.hpp"
#include "tests/workflows/viewing/web_map_fixture.hpp"
#include "workflows/viewing/web_map.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// Compares all tiles of an archive with the map.
void expect_whole(const SlowArchive& archive, const std::string& file, int top) {
  const geodb::MapStore map = geodb::MapStore::open(file);
  std::map<std::string, Landmark> by_uid;
  for (Landmark& one : map.query({})) by_uid[one.uid] = one;
  const double half_turn = std::numbers::pi;
  std::map<int, std::map<std::string, int>> shown;  // by zoom and uid
  std::map<int, std::int64_t> total;
  std::map<std::string, std::vector<exporters::ExportColumn>> columns_of;
  for (const auto& [key, content] : archive.tiles) {
    const auto& [zoom, column, row] = key;
    for (const auto& [layer, features] : read_vector_tile(gunzip(content))) {
      const auto& columns =
          columns_of.try_emplace(layer, exporters::export_columns(map.types()[map.types().id(layer)]))
              .first->second;
      for (const TileFeature& feature : features) {
        const auto& p = feature.properties;
        const std::string uid = std::get<std::string>(p.at("uid"));
        const Landmark& one = by_uid.at(uid);
        ++shown[zoom][uid];
        const auto hidden = p.find("hidden");
        total[zoom] += 1 + (hidden == p.end() ? 0 : std::llround(std::get<double>(hidden->second)));
        EXPECT_EQ(map.types()[one.type].name, layer);

        const double steps = std::ldexp(4096, zoom);
        const auto [u, v] = world_of(map.crs(), one.position.xyz.x(), one.position.xyz.y());
        EXPECT_TRUE(360 * u - 180 > archive.west && 360 * u - 180 < archive.east) << uid;
        const double latitude = std::atan(std::sinh(half_turn * (1 - 2 * v))) * 180 / half_turn;
        EXPECT_TRUE(latitude > archive.south && latitude < archive.north) << uid;
        ASSERT_NEAR(column * 4096.0 + double(feature.x) + 0.5, u * steps, 0.5 + 1e-5 * steps / 4096) << uid;
        ASSERT_NEAR(row * 4096.0 + double(feature.y) + 0.5, v * steps, 0.5 + 1e-5 * steps / 4096) << uid;
        ASSERT_TRUE(feature.x >= 0 && feature.x < 4096 && feature.y >= 0 && feature.y < 4096);
        EXPECT_EQ(std::get<double>(p.at("x")), one.position.xyz.x());
        EXPECT_EQ(std::get<double>(p.at("y")), one.position.xyz.y());
        for (const exporters::ExportColumn& c : columns) {
          const AttributeValue value = c.value(one);
          if (c.name.starts_with("var_") || c.name == "cov_xy") continue;
          ASSERT_EQ(p.contains(c.name), value.index() != 0) << c.name;
          if (const auto* real = std::get_if<double>(&value)) {
            EXPECT_EQ(std::get<double>(p.at(c.name)), double(float(*real))) << c.name;
          }
          if (const auto* number = std::get_if<std::int64_t>(&value)) {
            EXPECT_EQ(std::get<double>(p.at(c.name)), double(*number)) << c.name;
          }
          if (const auto* word = std::get_if<std::string>(&value)) {
            EXPECT_EQ(std::get<std::string>(p.at(c.name)), *word) << c.name;
          }
        }
      }
    }
  }
  for (int zoom = 0; zoom <= top; ++zoom) {
    EXPECT_EQ(total[zoom], std::int64_t(by_uid.size())) << "zoom " << zoom;
    for (const auto& [uid, times] : shown[zoom]) EXPECT_EQ(times, 1) << uid << " at zoom " << zoom;
  }
  EXPECT_EQ(shown[top].size(), by_uid.size());
  EXPECT_EQ(shown.size(), std::size_t(top) + 1);
  EXPECT_LT(shown[0].size(), by_uid.size());
}

TEST_F(WebMap, EveryTileHoldsTheLandmarksOfTheMap) {
  struct Case {
    const char* crs;
    double x, y, spread;
  };
  for (const Case& one : {Case{"EPSG:32632", 500000, 5.2e6, 3000}, Case{"IAU_2015:49900", 179.5, -18, 2},
                          Case{"local", 20, -30, 200}}) {
    SCOPED_TRACE(one.crs);
    const std::string map = write(made_map(one.crs, one.x, one.y, one.spread, 1500));
    const WebMapResult made = make_web_map({.map = map, .output = site()});
    EXPECT_EQ(made.landmarks, 1500);
    EXPECT_EQ(made.outside, 0);
    const SlowArchive archive = read_archive(text("landmarks.pmtiles"));
    EXPECT_EQ(std::int64_t(archive.tiles.size()), made.landmark_tiles);
    EXPECT_EQ(archive.header.at("type"), 1u);
    EXPECT_EQ(archive.header.at("compression"), 2u);
    EXPECT_EQ(archive.header.at("max_zoom"), std::uint64_t(made.max_zoom));
    expect_whole(archive, map, made.max_zoom);
    EXPECT_EQ(Json::parse(archive.metadata)["vector_layers"].size(), 3u);
  }
}

TEST_F(WebMap, TheForemostOfAClusterIsTheOneThatMeansMost) {
  geodb::MapContents contents = made_map("local", 0, 0, 0.2, 1200);
  std::string best;
  double most = 0;
  for (const Landmark& one : contents.landmarks) {
    const LandmarkType& type = contents.types[one.type];
    const auto size = std::ranges::find(type.features, type.size_feature, &FeatureSpec::name);
    if (type.name != "rock" || size == type.features.end()) continue;
    const FeatureValue& value = one.features[std::size_t(size - type.features.begin())];
    if (value.known() && value.value * one.confidence > most)
      most = value.value * one.confidence, best = one.uid;
  }
  ASSERT_FALSE(best.empty());
  make_web_map({.map = write(contents), .output = site()});
  const SlowArchive archive = read_archive(text("landmarks.pmtiles"));
  const auto layers = read_vector_tile(gunzip(archive.tiles.at({0, 0, 0})));
  // More than a tile may show lie about the middle of the world, where four cells meet: each has its
  // foremost.
  std::set<std::string> shown;
  for (const TileFeature& one : layers.at("rock"))
    shown.insert(std::get<std::string>(one.properties.at("uid")));
  EXPECT_LE(shown.size(), 4u);
  EXPECT_TRUE(shown.contains(best));
}

TEST_F(WebMap, TypesAndDoubtfulLandmarksCanBeLeftOut) {
  const geodb::MapContents contents = made_map("local", 0, 0, 100, 300);
  const std::string map = write(contents), type = "crater";
  const auto kept = std::ranges::count_if(contents.landmarks, [&](const Landmark& one) {
    return contents.types[one.type].name == type && one.confidence >= 0.5;
  });
  const WebMapResult made =
      make_web_map({.map = map, .output = site(), .types = {type}, .min_confidence = 0.5});
  EXPECT_EQ(made.landmarks, kept);
  const Json style = Json::parse(text("style.json"));
  ASSERT_EQ(style["metadata"]["waymark"]["types"].size(), 1u);
  EXPECT_EQ(style["metadata"]["waymark"]["types"][0]["count"], kept);
}

TEST_F(WebMap, PolarLandmarksOfAGeographicMapAreCounted) {
  geodb::MapContents contents = made_map("IAU_2015:30100", 10, -80, 1, 30);
  contents.landmarks[0].position.xyz.y() = -86;
  std::string warning;
  const WebMapResult made =
      make_web_map({.map = write(contents), .output = site()}, {.message = [&](const Message& message) {
                     if (message.kind == MessageKind::warning) warning = message.text;
                   }});
  EXPECT_EQ(made.outside, 1);
  EXPECT_EQ(made.landmarks, 29);
  EXPECT_THAT(warning, HasSubstr("1 landmarks lie beyond 85.05 degrees of latitude"));
}

}  // namespace
}  // namespace waymark::test
