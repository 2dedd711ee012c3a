// SPDX-License-Identifier: Apache-2.0
// Whole web maps: every tile is decoded by a reader of its own and compared with the map, landmark by
// landmark.
#include "workflows/viewing/web_map.hpp"

#include <gmock/gmock.h>
#include <sys/mount.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>

#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "core/text_file.hpp"
#include "exporters/vector/export_columns.hpp"
#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/slow_pmtiles.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

/// Some hundred landmarks of three types about a place: clusters, unknown values, equal positions.
geodb::MapContents made_map(const std::string& crs, double x, double y, double spread, int count) {
  geodb::MapContents map;
  map.types = all_types();
  map.crs = crs == "local" ? Crs::local() : Crs::from_text(crs);
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < count; ++i) {
    const TypeId id = map.types.id(std::array{"rock", "crater", "mountain_top"}[std::size_t(i % 3)]);
    const LandmarkType& type = map.types[id];
    Landmark one;
    one.uid = type.name + "-" + std::to_string(i);
    one.type = id;
    const double far = std::pow(unit(random), 3);
    one.position.xyz = {x + spread * far * (2 * unit(random) - 1), y + spread * far * (2 * unit(random) - 1),
                        100 * unit(random)};
    if (map.crs.kind() == CrsKind::geographic && one.position.xyz.x() > 180) one.position.xyz.x() -= 360;
    if (i % 50 == 0 && !map.landmarks.empty()) one.position = map.landmarks.back().position;
    one.covariance.diagonal() << 0.25, 0.09, 1;
    one.features.resize(type.features.size());
    for (FeatureValue& feature : one.features)
      if (random() % 5) feature = {0.5 + 30 * unit(random), unit(random), 1 + int(random() % 3)};
    one.attributes.resize(type.attributes.size());
    one.quality = {1 + i % 4, 4, std::vector<std::optional<double>>(type.features.size())};
    one.confidence = unit(random);
    one.observations = 1 + i % 4;
    map.landmarks.push_back(one);
  }
  map.run.version = "1";
  map.run.command_line = "made";
  map.run.job_json = map.run.report_json = "{}";
  map.run.started_utc = "2026-01-02T00:00:00Z";
  return map;
}

/// Position on the world by the formulas of web maps, written down once more.
std::pair<double, double> world_of(const Crs& crs, double x, double y) {
  if (crs.kind() == CrsKind::local) {
    const double width = 2 * std::numbers::pi * 6371008.8;
    return {0.5 + x / width, 0.5 - y / width};
  }
  if (crs.kind() == CrsKind::projected) {
    static const CrsTransform to_lonlat(Crs::from_text("EPSG:32632"), Crs::from_text("EPSG:4326"));
    const auto at = to_lonlat(x, y);
    x = at.x, y = at.y;
  }
  const double phi = y * std::numbers::pi / 180;
  const double v = 0.5 - std::log(std::tan(std::numbers::pi / 4 + phi / 2)) / (2 * std::numbers::pi);
  return {std::fmod(x / 360 + 1.5, 1.0), v};
}

class WebMap : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder()); }

  fs::path folder() const { return room_.path(); }
  std::string write(const geodb::MapContents& contents) const {
    geodb::write_map(folder() / "map.gpkg", contents);
    return (folder() / "map.gpkg").string();
  }
  std::string site() const { return (folder() / "site").string(); }
  std::string text(const std::string& name) const { return read_text(fs::path(site()) / name, "a file"); }

  LockedFolder room_{fs::temp_directory_path()};
};

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

using Polygon = std::vector<std::vector<Eigen::Vector2d>>;  // rings, even-odd rule

bool is_inside(const Polygon& polygon, const Eigen::Vector2d& at) {
  bool inside = false;
  for (const auto& ring : polygon)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > at.y()) != (b.y() > at.y()) &&
          at.x() < a.x() + (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y()))
        inside = !inside;
    }
  return inside;
}

double distance_to_edge(const Polygon& polygon, const Eigen::Vector2d& at) {
  double least = 1e300;
  for (const auto& ring : polygon)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], d = ring[(i + 1) % ring.size()] - a;
      const double along = std::clamp(d.dot(at - a) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
      least = std::min(least, (at - a - along * d).norm());
    }
  return least;
}

/// A stand of two parts, one with a hole, a stand beside it, and crowns.
std::vector<geodb::ShapeLayer> made_areas(double x, double y, double unit) {
  using Kind = AttributeSpec::Kind;
  const auto box = [&](double west, double south, double east, double north) -> std::vector<Eigen::Vector2d> {
    return {{x + unit * west, y + unit * south},
            {x + unit * east, y + unit * south},
            {x + unit * east, y + unit * north},
            {x + unit * west, y + unit * north}};
  };
  geodb::ShapeLayer stands{.name = "stand",
                           .summary = "Stands",
                           .columns = {{"stand", "", Kind::text, "Name"},
                                       {"stems_per_ha", "1/ha", Kind::real, "Stems"},
                                       {"stems_per_ha_se", "1/ha", Kind::real, ""},
                                       {"stems_per_ha_d005", "1/ha", Kind::real, "By class"}}};
  stands.rows.push_back(
      {.parts = {{box(0, 0, 400, 300), {box(100, 100, 180, 220)}}, {box(450, 0, 500, 300), {}}},
       .values = {std::string("A"), 412.5, 20.25, 7.0}});
  stands.rows.push_back(
      {.parts = {{{{x, y + unit * 300}, {x + unit * 400, y + unit * 300}, {x + unit * 200, y + unit * 511.3}},
                  {}}},
       .values = {std::string("B"), AttributeValue(), AttributeValue(), AttributeValue()}});
  geodb::ShapeLayer crowns{.name = "crown",
                           .summary = "Crowns",
                           .columns = {{"uid", "", Kind::text, ""}, {"height", "m", Kind::real, ""}}};
  for (int i = 0; i < 60; ++i) {
    std::vector<Eigen::Vector2d> ring;
    const double radius = unit * (1.5 + i % 5);
    for (int k = 0; k < 12; ++k)
      ring.emplace_back(x + unit * (7 * i + 3) + radius * std::cos(k * std::numbers::pi / 6),
                        y + unit * (37 * i % 300) + radius * std::sin(k * std::numbers::pi / 6));
    crowns.rows.push_back({.parts = {{ring, {}}}, .values = {"tree-" + std::to_string(i), 10.5 + i}});
  }
  return {stands, crowns};
}

/// Compares every tile with the polygons of the map at random points, away from the edges of polygons.
void expect_areas(const SlowArchive& archive, const Crs& crs, const std::vector<geodb::ShapeLayer>& areas,
                  int top) {
  std::map<std::string, std::map<std::string, Polygon>> known;  // by layer and name, on the world
  for (const geodb::ShapeLayer& layer : areas)
    for (const geodb::Shape& row : layer.rows) {
      Polygon& polygon = known[layer.name][std::get<std::string>(row.values[0])];
      const auto add = [&](const std::vector<Eigen::Vector2d>& ring) {
        polygon.emplace_back();
        for (const Eigen::Vector2d& p : ring) {
          auto [u, v] = world_of(crs, p.x(), p.y());
          if (u > 0.75) u -= 1;  // the areas of a case lie within half a world
          polygon.back().emplace_back(u, v);
        }
      };
      for (const geodb::ShapePart& part : row.parts) {
        add(part.outer);
        for (const auto& hole : part.holes) add(hole);
      }
    }
  std::mt19937 random(23);
  std::map<std::string, int> inside;
  for (const auto& [key, content] : archive.tiles) {
    const auto& [zoom, column, row] = key;
    std::map<std::string, std::map<std::string, Polygon>> shown;
    for (const auto& [layer, features] : read_vector_tile(gunzip(content)))
      for (const TileFeature& feature : features) {
        EXPECT_FALSE(feature.properties.contains("stems_per_ha_d005"));
        Polygon& polygon = shown[layer][std::get<std::string>(feature.properties.begin()->first == "height"
                                                                  ? feature.properties.at("uid")
                                                                  : feature.properties.at("stand"))];
        for (const auto& ring : feature.rings) {
          polygon.emplace_back();
          for (const auto& [u, v] : ring) {
            polygon.back().emplace_back(double(u), double(v));
            EXPECT_TRUE(u >= -64 && u <= 4160 && v >= -64 && v <= 4160);
          }
        }
      }
    const double steps = std::ldexp(4096, zoom);
    for (const auto& [layer, polygons] : known)
      for (const auto& [name, polygon] : polygons) {
        Polygon here = polygon;  // in steps of the tile
        Eigen::AlignedBox2d box;
        for (auto& ring : here)
          for (Eigen::Vector2d& p : ring) {
            double u = p.x();
            if (column * 4096.0 / steps > 0.75) u += 1;
            p = Eigen::Vector2d(u * steps - column * 4096.0, p.y() * steps - row * 4096.0);
            box.extend(p);
          }
        if (zoom < top && box.sizes().maxCoeff() < 33) {
          if (box.sizes().maxCoeff() < 31) {
            EXPECT_FALSE(shown[layer].contains(name)) << layer << name << zoom;
          }
          continue;
        }
        const Eigen::AlignedBox2d tile(Eigen::Vector2d(0, 0), Eigen::Vector2d(4096, 4096));
        const Eigen::AlignedBox2d common = box.intersection(tile);
        if (common.isEmpty()) continue;
        for (int i = 0; i < 12; ++i) {
          const auto part = [&] { return double(random() % 100001) / 1e5; };
          const Eigen::Vector2d at =
              common.min() + Eigen::Vector2d(part(), part()).cwiseProduct(common.sizes());
          if (distance_to_edge(here, at) < (zoom < top ? 6 : 2)) continue;
          const bool is_shown = shown[layer].contains(name) && is_inside(shown[layer][name], at);
          ASSERT_EQ(is_shown, is_inside(here, at))
              << layer << ' ' << name << " zoom " << zoom << " at " << at.transpose();
          inside[layer] += is_shown;
        }
      }
  }
  EXPECT_GT(inside["stand"], 100);
  EXPECT_GT(inside["crown"], 100);
}

TEST_F(WebMap, EveryTileHoldsTheAreasOfTheMap) {
  struct Case {
    const char* crs;
    double x, y, unit;
  };
  for (const Case& one : {Case{"EPSG:32632", 500000, 5.2e6, 1}, Case{"local", -120, 60, 1},
                          Case{"IAU_2015:49900", 179.998, -18, 1e-5}}) {
    SCOPED_TRACE(one.crs);
    geodb::MapContents contents = made_map(one.crs, one.x, one.y, 100 * one.unit, 30);
    contents.layers = made_areas(one.x, one.y, one.unit);
    const WebMapResult made = make_web_map({.map = write(contents), .output = site()});
    EXPECT_EQ(made.shapes, 62);
    const SlowArchive archive = read_archive(text("shapes.pmtiles"));
    EXPECT_EQ(std::int64_t(archive.tiles.size()), made.shape_tiles);
    EXPECT_GT(made.shape_tiles, 20);
    expect_areas(archive, contents.crs, contents.layers, int(archive.header.at("max_zoom")));
    const Json style = Json::parse(text("style.json"));
    const Json& shapes = style["metadata"]["waymark"]["shapes"];
    ASSERT_EQ(shapes.size(), 2u);
    EXPECT_EQ(shapes[0]["name"], "stand");
    EXPECT_EQ(shapes[0]["count"], 2);
    EXPECT_EQ(shapes[1]["count"], 60);
    EXPECT_EQ(Json::parse(archive.metadata)["vector_layers"].size(), 2u);
  }
  make_web_map({.map = write(made_map("local", 0, 0, 100, 30)), .output = site()});
  EXPECT_FALSE(fs::exists(fs::path(site()) / "shapes.pmtiles"));
}

TEST_F(WebMap, BytesDoNotDependOnThreads) {
  geodb::MapContents contents = made_map("EPSG:32632", 500000, 5.2e6, 3000, 900);
  contents.layers = made_areas(500000, 5.2e6, 1);
  const std::string map = write(contents);
  std::map<std::string, std::string> first;
  for (const int threads : {1, 3}) {
    make_web_map({.map = map, .output = site(), .threads = threads});
    for (const auto& entry : fs::directory_iterator(site())) {
      const std::string name = entry.path().filename();
      const auto [known, is_new] = first.try_emplace(name, text(name));
      EXPECT_EQ(known->second, text(name)) << name;
    }
  }
  EXPECT_EQ(first.size(), 7u);
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

TEST_F(WebMap, TheStyleHasTheColoursOfTheTypesAndTheScaleOfTheBody) {
  const geodb::MapContents contents = made_map("IAU_2015:49900", 77, 18, 1, 60);
  make_web_map({.map = write(contents), .output = site(), .title = "Jezero <1>"});
  const Json style = Json::parse(text("style.json"));
  const Json& about = style["metadata"]["waymark"];
  EXPECT_EQ(about["body"], "Mars");
  EXPECT_EQ(about["radius"], contents.crs.body().equatorial_radius);
  EXPECT_EQ(about["plane"], false);
  EXPECT_EQ(style["name"], "Jezero <1>");
  EXPECT_THAT(text("index.html"), HasSubstr("<title>Jezero &lt;1&gt;</title>"));
  int found = 0;
  for (const Json& layer : style["layers"])
    if (layer["type"] == "circle") {
      const LandmarkType* type = contents.types.find(layer["source-layer"].get<std::string>());
      const Json& paint = layer["paint"];
      EXPECT_TRUE(paint["circle-color"] == type->colour);
      ++found;
    }
  EXPECT_EQ(found, 3);
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

TEST_F(WebMap, AMapWithoutLandmarksIsNamed) {
  const std::string map = write(made_map("local", 0, 0, 1, 0));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site()}); }),
              HasSubstr("the map has no landmarks to show"));
  EXPECT_FALSE(fs::exists(site()));
}

TEST_F(WebMap, OtherPeoplesFilesAreKept) {
  const std::string map = write(made_map("local", 0, 0, 1, 9));
  make_web_map({.map = map, .output = site()});
  make_web_map({.map = map, .output = site()});  // a web map is replaced
  fs::copy_file(map, fs::path(site()) / "thesis.gpkg");
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site()}); }),
              HasSubstr("the folder holds files that are no part of a web map, such as thesis.gpkg"));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = map}); }),
              HasSubstr("the output is a file, and a web map is a folder"));
}

TEST_F(WebMap, ALibraryOfAnotherVersionIsRefused) {
  const std::string map = write(made_map("local", 0, 0, 1, 9));
  fs::create_directories(folder() / "lib");
  EXPECT_THAT(message_of([&] {
                make_web_map({.map = map, .output = site(), .assets = (folder() / "lib").string()});
              }),
              HasSubstr("maplibre-gl.js"));
  fs::copy_file(map, folder() / "lib/maplibre-gl.js");
  EXPECT_THAT(message_of([&] {
                make_web_map({.map = map, .output = site(), .assets = (folder() / "lib").string()});
              }),
              HasSubstr("maplibre-gl.js is not the version that the page is made for"));
}

TEST_F(WebMap, ATerrainThatIsNoDemAndAZoomBeyondAllAreNamed) {
  const std::string map = write(made_map("local", 0, 0, 1, 9));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site(), .dem = {map}}); }),
              HasSubstr("no elevation model of this map's body and kind of CRS could be read"));
  EXPECT_THAT(message_of([&] { make_web_map({.map = map, .output = site(), .max_zoom = 23}); }),
              HasSubstr("zoom 23 is finer than any map tile"));
}

TEST_F(WebMap, AFullDiskLeavesTheOlderMap) {
  const fs::path disk = folder() / "disk";
  fs::create_directories(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=300k") != 0)
    GTEST_SKIP() << "a small tmpfs can only be mounted by root";
  const std::string small = write(made_map("local", 0, 0, 100, 30)), target = (disk / "site").string();
  make_web_map({.map = small, .output = target});
  const std::string before = read_text(disk / "site/landmarks.pmtiles", "a file");
  const std::string large = write(made_map("local", 0, 0, 100, 5000));
  const std::string message = message_of([&] { make_web_map({.map = large, .output = target}); });
  EXPECT_THAT(message, HasSubstr("the disk is full"));
  EXPECT_EQ(read_text(disk / "site/landmarks.pmtiles", "a file"), before);
  ::umount2(disk.c_str(), MNT_DETACH);
}

}  // namespace
}  // namespace waymark::test
