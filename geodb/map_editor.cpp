// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_editor.hpp"

#include "core/error.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/geopackage/provenance.hpp"
#include "geodb/layers/evidence.hpp"
#include "geodb/map_connection.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

using Connection = MapStore::Connection;

void check_landmark(const Connection& map, const Landmark& landmark) {
  if (landmark.type >= map.tables.size())
    throw Error(ErrorCode::usage, "the map has no table for this type of landmark", map.path.string(),
                "write the map again with that type");
  if (landmark.uid.empty() || !landmark.position.xyz.allFinite())
    throw Error(ErrorCode::input, "a landmark needs a uid and a finite position", landmark.uid);
}

Connection::StoredLandmark find_or_throw(Connection& map, std::string_view uid) {
  auto found = map.find(uid);
  if (!found)
    throw Error(ErrorCode::input, "the map has no landmark '" + std::string(uid) + "'", map.path.string());
  return std::move(*found);
}

/// Extends the extent in gpkg_contents, which need not be tight (GeoPackage, table 5).
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

bool database_has_images(const sqlite::Database& database) {
  return database.integer("SELECT count(*) FROM gpkg_contents WHERE table_name = 'image'") > 0;
}

/// An edit by Waymark measures the landmark again, so it is not stale.
void forget_move(const Connection& map, std::int64_t row) {
  sqlite::Statement moved = map.database.prepare("DELETE FROM waymark_moved WHERE id = ?");
  moved.bind(1, row);
  moved.run();
}

}  // namespace

MapEditor MapEditor::open(const std::filesystem::path& path) {
  return MapEditor(MapStore(std::make_unique<Connection>(path, open_for_update(path))));
}

MapEditor::MapEditor(MapStore map) : map_(std::move(map)) {}

void MapEditor::insert(const Landmark& landmark) {
  transact([&] {
    Connection& map = *map_.connection_;
    check_landmark(map, landmark);
    LandmarkTable& table = map.tables[landmark.type];
    table.by_uid.bind(1, landmark.uid);
    if (table.by_uid.step()) {
      table.by_uid.reset();
      throw Error(ErrorCode::input, "the map has a landmark '" + landmark.uid + "' already",
                  map.path.string(), "update it");
    }
    const std::int64_t last =
        map.database.integer("SELECT max(id) FROM " + quote_identifier(table.layout.type().name));
    store(map, table, table.layout.insert(), std::max(last, landmark.type * kRowsPerType) + 1, landmark);
  });
}

void MapEditor::update(const Landmark& landmark) {
  transact([&] {
    Connection& map = *map_.connection_;
    check_landmark(map, landmark);
    const auto found = find_or_throw(map, landmark.uid);
    if (found.landmark.type != landmark.type)
      throw Error(ErrorCode::input, "landmark '" + landmark.uid + "' is of another type", map.path.string(),
                  "remove it and insert the new one");
    store(map, *found.table, found.table->layout.update(), found.row, landmark);
    forget_move(map, found.row);
  });
}

void MapEditor::remove(std::string_view uid) {
  transact([&] {
    Connection& map = *map_.connection_;
    const auto found = find_or_throw(map, uid);
    const std::string& table = found.table->layout.type().name;
    for (const char* sql :
         {R"(DELETE FROM "{t}" WHERE id = ?)", R"(DELETE FROM "{t}_observation" WHERE base_id = ?)"}) {
      sqlite::Statement statement = map.database.prepare(substitute_keys(sql, {{"t", table}}));
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
  transact([&] {
    Connection& map = *map_.connection_;
    const bool kept = observation.rejected.empty();
    std::optional<std::int64_t> row;
    if (kept) {
      const auto found = find_or_throw(map, observation.landmark_uid);
      row = found.row;
      sqlite::Statement count =
          map.database.prepare("UPDATE " + quote_identifier(found.table->layout.type().name) +
                               " SET observations = observations + 1 WHERE id = ?");
      count.bind(1, *row);
      count.run();
    }
    EvidenceWriter(map.database, map.types).add(observation, row);
  });
}

void MapEditor::add_image(const ImageRecord& image) {
  transact([&] {
    Connection& map = *map_.connection_;
    if (!database_has_images(map.database)) {
      create_spatial_index(map.database, "image");
      register_images(map.database, {}, map.srs_id, time_stamp_now());
    }
    write_image(map.database, image, map.srs_id);
    Envelope box;
    for (const auto& ring : image.footprint)
      for (const auto& corner : ring) box.add(corner.x(), corner.y());
    if (!box.empty()) widen_extent(map, "image", box);
  });
}

void MapEditor::add_run(const RunRecord& run) {
  transact([&] { write_run(map_.connection_->database, run); });
}

void MapEditor::transact(const std::function<void()>& changes) {
  if (in_transaction_) return changes();
  sqlite::Transaction all(map_.connection_->database);
  in_transaction_ = true;
  try {
    changes();
    all.commit();
  } catch (...) {
    in_transaction_ = false;
    throw;
  }
  in_transaction_ = false;
}

}  // namespace waymark::geodb
