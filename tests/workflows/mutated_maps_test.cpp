// SPDX-License-Identifier: Apache-2.0
// The readers of maps, given hundreds of damaged files.
#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/support/mutated_files.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;

/// Reads everything that commands read of a map.
void read_map(const std::string& path) {
  const geodb::MapStore map = geodb::MapStore::open(path);
  for (const std::string& type : map.types().names()) map.visit(type, [](Landmark&&) {});
  map.query({.nearest = geodb::MapQuery::NearestK{0, 0, 3}});
  map.visit_observations([](Observation&&) {});
  map.images();
  map.runs();
  for (const std::string& layer : geodb::shape_layers(path)) geodb::read_shape_layer(path, layer);
}

std::string map_bytes(const fs::path& folder) {
  geodb::MapContents contents;
  contents.types = all_types();
  const TypeId rock = contents.types.id("rock");
  const LandmarkType& type = contents.types[rock];
  for (int i = 0; i < 20; ++i) {
    Landmark l;
    l.uid = "rk-" + std::to_string(i);
    l.type = rock;
    l.position.xyz << i % 5, i / 5, 0;
    l.features.resize(type.features.size());
    l.attributes.resize(type.attributes.size());
    l.quality = {1, 1, std::vector<std::optional<double>>(type.features.size())};
    contents.landmarks.push_back(l);
    Observation o;
    o.type = rock;
    o.landmark_uid = l.uid;
    o.source = "a.png";
    o.position = l.position;
    o.features.resize(type.features.size());
    contents.observations.push_back(o);
  }
  contents.images = {{.name = "a.png",
                      .footprint = {{{0, 0}, {5, 0}, {5, 5}}},
                      .camera_json = "{}",
                      .taken_utc = {},
                      .sun_azimuth = {},
                      .sun_elevation = {},
                      .gsd = {}}};
  contents.layers = {{.name = "track",
                      .summary = "Track",
                      .kind = geodb::ShapeKind::line,
                      .columns = {},
                      .rows = {{.parts = {{.outer = {{0, 0}, {4, 4}}}}, .values = {}}}}};
  contents.run.started_utc = "2026-11-21T07:21:14Z";
  geodb::write_map(folder / "made.gpkg", contents, {.empty_tables = {"rock"}});
  return read_text(folder / "made.gpkg", "the map");
}

TEST_F(MutatedFiles, OfMaps) {
  check("map.gpkg", map_bytes(folder_), Content::binary, 150, read_map);
}

TEST_F(MutatedFiles, OfMapsThatAreChecked) {
  check("map.gpkg", map_bytes(folder_), Content::binary, 100, [](const std::string& path) {
    if (!geodb::validate_map(path).empty()) throw Error(ErrorCode::input, "the map has errors", path);
  });
}

}  // namespace
}  // namespace waymark::test
