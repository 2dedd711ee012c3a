// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_editor.hpp"

#include "core/error.hpp"
#include "geodb/evidence.hpp"
#include "geodb/geometry_blob.hpp"
#include "geodb/map_connection.hpp"
#include "geodb/provenance.hpp"
#include "geodb/sql_text.hpp"

namespace waymark {
namespace {

using Connection = MapStore::Connection;

void check_landmark(const Connection& map, const Landmark& landmark) {
  if (landmark.type >= map.tables.size())
    throw Error(ErrorCode::usage, "the map has no table for this type of landmark", map.path.string(),
                "write it anew with that type");
  if (landmark.uid.empty() || !landmark.position.xyz.allFinite())
    throw Error(ErrorCode::input, "a landmark needs a uid and a finite position", landmark.uid);
}

Connection::Found must_find(Connection& map, std::string_view uid) {
  auto found = map.find(uid);
  if (!found)
    throw Error(ErrorCode::input, "the map has no landmark '" + std::string(uid) + "'", map.path.string());
  return std::move(*found);
}

/// The extents in gpkg_contents grow with the map; they need not be tight (GeoPackage, table 5).
void widen_extent(const Connection& map, std::string_view table, const Envelope& box) {
  sqlite::Statement widen = map.database.prepare(
      "UPDATE gpkg_contents SET last_change = ?2,"
      "  min_x = min(coalesce(min_x, ?3), ?3), min_y = min(coalesce(min_y, ?4), ?4),"
      "  max_x = max(coalesce(max_x, ?5), ?5), max_y = max(coalesce(max_y, ?6), ?6) WHERE table_name = ?1");
  const std::string now = time_stamp_now();
  widen.bind_all(table, now, box.min_x, box.min_y, box.max_x, box.max_y);
  widen.run();
}

void store(const Connection& map, const LandmarkTable& table, const std::string& sql, std::int64_t row,
           const Landmark& landmark) {
  const Eigen::Vector3d& at = landmark.position.xyz;
  const PointBlob geometry = point_blob(at, map.srs_id);
  sqlite::Statement statement = map.database.prepare(sql);
  table.layout.bind(statement, row, landmark, geometry);
  statement.run();
  Envelope box;
  box.add(at.x(), at.y());
  for (const std::string_view layer :
       {std::string_view(table.layout.type().name), std::string_view("landmark")})
    widen_extent(map, layer, box);
}

}  // namespace

MapEditor MapEditor::open(const std::filesystem::path& path) {
  return MapEditor(MapStore(std::make_unique<Connection>(path, open_for_changing(path))));
}

MapEditor::MapEditor(MapStore map) : map_(std::move(map)) {}

void MapEditor::insert(const Landmark& landmark) {
  together([&] {
    Connection& map = *map_.connection_;
    check_landmark(map, landmark);
    LandmarkTable& table = map.tables[landmark.type];
    table.of_uid.bind(1, landmark.uid);
    if (table.of_uid.step()) {
      table.of_uid.reset();
      throw Error(ErrorCode::input, "the map has a landmark '" + landmark.uid + "' already",
                  map.path.string(), "update it");
    }
    const std::int64_t last =
        map.database.integer("SELECT max(id) FROM " + sql_name(table.layout.type().name));
    store(map, table, table.layout.insert(), std::max(last, landmark.type * kRowsPerType) + 1, landmark);
  });
}

void MapEditor::update(const Landmark& landmark) {
  together([&] {
    Connection& map = *map_.connection_;
    check_landmark(map, landmark);
    const auto found = must_find(map, landmark.uid);
    if (found.landmark.type != landmark.type)
      throw Error(ErrorCode::input, "landmark '" + landmark.uid + "' is of another type", map.path.string(),
                  "remove it and insert the new one");
    store(map, *found.table, found.table->layout.update(), found.row, landmark);
  });
}

void MapEditor::remove(std::string_view uid) {
  together([&] {
    Connection& map = *map_.connection_;
    const auto found = must_find(map, uid);
    const std::string& table = found.table->layout.type().name;
    for (const char* sql :
         {R"(DELETE FROM "{t}" WHERE id = ?)", R"(DELETE FROM "{t}_observation" WHERE base_id = ?)"}) {
      sqlite::Statement statement = map.database.prepare(fill_in(sql, {{"t", table}}));
      statement.bind(1, found.row);
      statement.run();
    }
    sqlite::Statement reject = map.database.prepare(
        "UPDATE observation SET rejected = 'landmark removed' WHERE type = ? AND uid = ? AND rejected IS "
        "NULL");
    reject.bind_all(table, uid);
    reject.run();
  });
}

void MapEditor::add_evidence(const Observation& observation) {
  together([&] {
    Connection& map = *map_.connection_;
    const bool kept = observation.rejected.empty();
    std::optional<std::int64_t> row;
    if (kept) {
      const auto found = must_find(map, observation.landmark_uid);
      row = found.row;
      sqlite::Statement count = map.database.prepare("UPDATE " + sql_name(found.table->layout.type().name) +
                                                     " SET observations = observations + 1 WHERE id = ?");
      count.bind(1, *row);
      count.run();
    }
    EvidenceWriter(map.database, map.types).add(observation, row);
  });
}

void MapEditor::add_image(const ImageRecord& image) {
  together([&] {
    Connection& map = *map_.connection_;
    write_image(map.database, image, map.srs_id);
    Envelope box;
    for (const auto& ring : image.footprint)
      for (const auto& corner : ring) box.add(corner.x(), corner.y());
    if (!box.empty()) widen_extent(map, "image", box);
  });
}

void MapEditor::add_run(const RunRecord& run) {
  together([&] { write_run(map_.connection_->database, run); });
}

void MapEditor::together(const std::function<void()>& changes) {
  if (together_) return changes();
  sqlite::Transaction all(map_.connection_->database);
  together_ = true;
  try {
    changes();
    all.commit();
  } catch (...) {
    together_ = false;
    throw;
  }
  together_ = false;
}

}  // namespace waymark
