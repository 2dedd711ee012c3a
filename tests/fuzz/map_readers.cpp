// SPDX-License-Identifier: Apache-2.0
#include "map_readers.hpp"

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/text_file.hpp"
#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

/// Reads everything that commands read of a map. Throws Error{input} if the map has errors.
void read_map(const std::string& path) {
  const bool sound = geodb::validate_map(path).empty();
  const geodb::MapStore map = geodb::MapStore::open(path);
  for (const std::string& type : map.types().names()) map.visit(type, [](Landmark&&) {});
  map.query({.nearest = geodb::MapQuery::NearestK{0, 0, 3}});
  map.visit_observations([](Observation&&) {});
  map.images();
  map.runs();
  for (const std::string& layer : geodb::shape_layers(path)) geodb::read_shape_layer(path, layer);
  if (!sound) throw Error(ErrorCode::input, "the map has errors", path);
}

geodb::MapContents contents() {
  geodb::MapContents made;
  made.types = workflows::all_types();
  const TypeId rock = made.types.id("rock");
  const LandmarkType& type = made.types[rock];
  for (int i = 0; i < 6; ++i) {
    Landmark l;
    l.uid = "rk-" + std::to_string(i);
    l.type = rock;
    l.position.xyz << i % 3, i / 3, 0;
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

std::string map_beside(const std::string& file, const std::string& bytes) {
  const std::string map = (fs::path(file).parent_path() / "map.gpkg").string();
  for (const char* part : {"", "-journal", "-wal", "-shm"}) fs::remove(map + part);
  if (write_aside(map, bytes) != 0) throw std::runtime_error("cannot write " + map);
  return map;
}

}  // namespace

const std::string& sound_map() {
  static const std::string bytes = [] {
    std::string folder = (fs::temp_directory_path() / "waymark-map-XXXXXX").string();
    if (!::mkdtemp(folder.data())) throw std::runtime_error("cannot make " + folder);
    geodb::write_map(folder + "/map.gpkg", contents(), {.empty_tables = {"rock"}});
    std::string made = read_text(folder + "/map.gpkg", "the map");
    fs::remove_all(folder);
    return made;
  }();
  return bytes;
}

void read_edited_map(const std::string& edits) {
  constexpr std::size_t kPosition = 3, kContent = 4;
  const std::string text = read_text(edits, "the edits");
  std::string bytes = sound_map();
  for (std::size_t i = 0; i + kPosition + kContent <= text.size(); i += kPosition + kContent) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < kPosition; ++k) at = at * 256 + static_cast<std::uint8_t>(text[i + k]);
    bytes.replace(at % (bytes.size() - kContent), kContent, text, i + kPosition, kContent);
  }
  read_map(map_beside(edits, bytes));
}

void read_altered_map(const std::string& sql) {
  const std::string text = read_text(sql, "the statements");
  const std::string map = map_beside(sql, sound_map());
  {
    sqlite3* opened = nullptr;
    if (sqlite3_open(map.c_str(), &opened) != SQLITE_OK) throw std::runtime_error("cannot open " + map);
    const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> db(opened, sqlite3_close);
    sqlite3_db_config(db.get(), SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    sqlite3_limit(db.get(), SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_limit(db.get(), SQLITE_LIMIT_LENGTH, 1 << 20);
    sqlite3_progress_handler(
        db.get(), 100'000, [](void*) { return 1; }, nullptr);
    sqlite3_exec(db.get(), "PRAGMA synchronous = OFF", nullptr, nullptr, nullptr);
    const char* rest = text.c_str();
    while (*rest) {  // one at a time: those that fail do not end the others
      sqlite3_stmt* statement = nullptr;
      const char* end = rest;
      if (sqlite3_prepare_v2(db.get(), rest, -1, &statement, &end) != SQLITE_OK || end == rest) break;
      for (int step = 0; step < 1000 && sqlite3_step(statement) == SQLITE_ROW; ++step) continue;
      sqlite3_finalize(statement);
      rest = end;
    }
  }
  read_map(map);
}

}  // namespace waymark::test
