// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/write_map.hpp"
#include "workflows/registries.hpp"
namespace waymark::test {

/// Returns a map with something in each of its tables: rocks on a lattice of so many columns, one observation
/// of each, an image, a line layer and a run.
inline geodb::MapContents map_with_everything(int rocks, int columns) {
  geodb::MapContents made;
  made.types = workflows::all_types();
  const TypeId rock = made.types.id("rock");
  const LandmarkType& type = made.types[rock];
  for (int i = 0; i < rocks; ++i) {
    Landmark l;
    l.uid = "rk-" + std::to_string(i);
    l.type = rock;
    l.position.xyz << i % columns, i / columns, 0;
    l.features.resize(type.features.size());
    l.attributes.resize(type.attributes.size());
    l.quality = {1, 1, std::vector<std::optional<double>>(type.features.size())};
    made.landmarks.push_back(l);
    Observation o;
    o.type = rock;
    o.landmark_uid = l.uid;
    o.source = "a.png";
    o.position = l.position;
    o.features.resize(type.features.size());
    made.observations.push_back(o);
  }
  made.images = {{.name = "a.png",
                  .footprint = {{{0, 0}, {5, 0}, {5, 5}}},
                  .camera_json = "{}",
                  .taken_utc = {},
                  .sun_azimuth = {},
                  .sun_elevation = {},
                  .gsd = {}}};
  made.layers = {{.name = "track",
                  .summary = "Track",
                  .kind = geodb::ShapeKind::line,
                  .columns = {},
                  .rows = {{.parts = {{.outer = {{0, 0}, {4, 4}}}}, .values = {}}}}};
  made.run.started_utc = "2026-11-21T07:21:14Z";
  return made;
}

/// Reads everything that commands read of a map.
inline void read_whole_map(const std::string& path) {
  const geodb::MapStore map = geodb::MapStore::open(path);
  for (const std::string& type : map.types().names()) map.visit(type, [](Landmark&&) {});
  map.query({.nearest = geodb::MapQuery::NearestK{0, 0, 3}});
  map.visit_observations([](Observation&&) {});
  map.images();
  map.runs();
  for (const std::string& layer : geodb::shape_layers(path)) geodb::read_shape_layer(path, layer);
}

}  // namespace waymark::test
