// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/locked_folder.hpp"
#include "core/text_file.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/write_map.hpp"
#include "workflows/registries.hpp"
namespace waymark::test {

/// Some hundred landmarks of three types about a place: clusters, unknown values, equal positions.
inline geodb::MapContents made_map(const std::string& crs, double x, double y, double spread, int count) {
  geodb::MapContents map;
  map.types = workflows::all_types();
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

/// A stand of two parts, one with a hole, a stand beside it, and crowns.
inline std::vector<geodb::ShapeLayer> made_areas(double x, double y, double unit) {
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

/// Position on the world by the formulas of web maps, written down once more.
inline std::pair<double, double> world_of(const Crs& crs, double x, double y) {
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

/// Writes maps into a folder of its own, and reads the web maps made there.
class WebMap : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder()); }

  std::filesystem::path folder() const { return room_.path(); }
  std::string write(const geodb::MapContents& contents) const {
    geodb::write_map(folder() / "map.gpkg", contents);
    return (folder() / "map.gpkg").string();
  }
  std::string site() const { return (folder() / "site").string(); }
  std::string text(const std::string& name) const {
    return read_text(std::filesystem::path(site()) / name, "a file");
  }

  LockedFolder room_{std::filesystem::temp_directory_path()};
};

}  // namespace waymark::test
