// SPDX-License-Identifier: Apache-2.0
// Areas of whole web maps: every tile is decoded and compared with the polygons of the map at random points.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/support/slow_pmtiles.hpp"
#include "tests/workflows/viewing/web_map_fixture.hpp"
#include "workflows/viewing/web_map.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

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

}  // namespace
}  // namespace waymark::test
