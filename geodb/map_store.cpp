// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_store.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "geodb/geopackage/crs_table.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/geopackage/provenance.hpp"
#include "geodb/geopackage/type_catalogue.hpp"
#include "geodb/layers/evidence.hpp"
#include "geodb/map_connection.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

Envelope extent_of_map(const sqlite::Database& database) {
  sqlite::Statement row = database.prepare(
      "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'landmark' AND min_x NOT "
      "NULL");
  if (!row.step()) return {};
  return {row.real(0), row.real(1), row.real(2), row.real(3)};
}

std::string box_condition(const std::string& table) {
  return substitute_keys(
      R"(JOIN "rtree_{t}_geom" r ON r.id = t.id WHERE r.maxx >= ?1 AND r.maxy >= ?2 AND r.minx <= ?3 AND r.miny <= ?4)",
      {{"t", table}});
}

std::string rows_in(const std::string& table, const MapQuery::Box& box) {
  return fmt::format(
      "SELECT id FROM {} WHERE maxx >= {:.17g} AND maxy >= {:.17g} AND minx <= {:.17g} AND miny <= {:.17g}",
      quote_identifier("rtree_" + table + "_geom"), box.min_x, box.min_y, box.max_x, box.max_y);
}

bool bounded(const SearchWindows& windows) {
  return windows.size() > 1 || std::isfinite(windows[0].min_x) || std::isfinite(windows[0].min_y);
}

}  // namespace

LandmarkTable::LandmarkTable(const sqlite::Database& database, const LandmarkType& type, TypeId id)
    : layout(type, id),
      all(database.prepare(layout.select("ORDER BY t.id"))),
      in_box(database.prepare(layout.select(box_condition(type.name)))),
      by_uid(database.prepare(layout.select("WHERE t.uid = ?"))) {}

MapStore::Connection::Connection(std::filesystem::path file, OpenMap map)
    : path(std::move(file)),
      database(std::move(map.database)),
      version(map.version),
      types(read_types(database)),
      srs_id(srs_id_of_map(database)),
      crs(read_crs(database, srs_id)),
      map_distance(crs),
      extent(extent_of_map(database)) {
  for (TypeId id = 0; id < types.size(); ++id) tables.emplace_back(database, types[id], id);
}

void MapStore::Connection::visit(LandmarkTable& table, const SearchWindows& windows, const Visit& visit) {
  const bool boxes = bounded(windows);
  sqlite::Statement& rows = boxes ? table.in_box : table.all;
  for (const MapQuery::Box& window : windows) {
    if (boxes) rows.bind_all(window.min_x, window.min_y, window.max_x, window.max_y);
    while (rows.step())
      if (!visit(rows)) return rows.reset();
  }
}

LandmarkTable& MapStore::Connection::table(std::string_view type) {
  if (types.find(type)) return tables[types.id(type)];
  const std::string nearest = nearest_name(type, types.names());
  std::string names;
  for (const auto& name : types.names()) names += (names.empty() ? "" : ", ") + name;
  throw Error(ErrorCode::usage, "this map has no landmarks of type '" + std::string(type) + "'",
              path.string(), nearest.empty() ? "it has: " + names : "did you mean '" + nearest + "'?");
}

std::optional<MapStore::Connection::StoredLandmark> MapStore::Connection::find(std::string_view uid) {
  for (LandmarkTable& table : tables) {
    table.by_uid.bind(1, uid);
    if (!table.by_uid.step()) continue;
    StoredLandmark found{LandmarkLayout::row_id(table.by_uid), &table, table.layout.read(table.by_uid)};
    table.by_uid.reset();
    return found;
  }
  return std::nullopt;
}

MapStore MapStore::open(const std::filesystem::path& path) {
  OpenMap map = open_for_reading(path);
  return with_map_name(path, [&] { return MapStore(std::make_unique<Connection>(path, std::move(map))); });
}

MapStore::MapStore(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
MapStore::~MapStore() = default;
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;

const std::filesystem::path& MapStore::path() const {
  return connection_->path;
}
int MapStore::schema_version() const {
  return connection_->version;
}
const TypeRegistry& MapStore::types() const {
  return connection_->types;
}
const Crs& MapStore::crs() const {
  return connection_->crs;
}

std::int64_t MapStore::count() const {
  std::int64_t total = 0;
  for (const auto& type : types()) total += count(type.name);
  return total;
}

std::int64_t MapStore::count(std::string_view type) const {
  const std::string& table = connection_->table(type).layout.type().name;
  return connection_->database.integer("SELECT count(*) FROM " + quote_identifier(table));
}

std::optional<Landmark> MapStore::find(std::string_view uid) const {
  auto found = connection_->find(uid);
  if (!found) return std::nullopt;
  return std::move(found->landmark);
}

double MapStore::distance(const Landmark& landmark, double x, double y) const {
  const auto& at = landmark.position.xyz;
  return connection_->map_distance(x, y, at.x(), at.y());
}

std::vector<Observation> MapStore::observations_of(std::string_view uid) const {
  return with_map_name(path(), [&] {
    return read_evidence(connection_->database, types(), "WHERE o.uid = ? AND o.rejected IS NULL", uid);
  });
}
std::vector<Observation> MapStore::observations() const {
  return with_map_name(path(), [&] { return read_evidence(connection_->database, types(), ""); });
}
void MapStore::visit(std::string_view type, const std::function<void(Landmark&&)>& visit) const {
  LandmarkTable& table = connection_->table(type);
  connection_->visit(table, whole_plane(), [&](const sqlite::Statement& row) {
    visit(table.layout.read(row));
    return true;
  });
}
void MapStore::visit(std::string_view type, const MapQuery::Box& box,
                     const std::function<void(Landmark&&)>& visit) const {
  const LandmarkLayout& layout = connection_->table(type).layout;
  sqlite::Statement row = connection_->database.prepare(
      layout.select("WHERE t.id IN (" + rows_in(layout.type().name, box) + ") ORDER BY t.id"));
  while (row.step()) {
    Landmark landmark = layout.read(row);
    const auto& at = landmark.position.xyz;  // the index rounds boxes outwards
    if (at.x() >= box.min_x && at.x() <= box.max_x && at.y() >= box.min_y && at.y() <= box.max_y)
      visit(std::move(landmark));
  }
}
std::vector<MapStore::RowRange> MapStore::row_ranges(std::string_view type, std::int64_t rows) const {
  const std::string& table = connection_->table(type).layout.type().name;
  sqlite::Statement row =
      connection_->database.prepare("SELECT id FROM " + quote_identifier(table) + " ORDER BY id");
  std::vector<RowRange> ranges;
  for (std::int64_t i = 0; row.step(); ++i) {
    if (i % rows == 0) ranges.push_back({row.integer(0), row.integer(0)});
    ranges.back().last = row.integer(0);
  }
  return ranges;
}
void MapStore::visit(std::string_view type, const RowRange& range,
                     const std::function<void(Landmark&&)>& visit) const {
  const LandmarkLayout& layout = connection_->table(type).layout;
  sqlite::Statement row =
      connection_->database.prepare(layout.select("WHERE t.id BETWEEN ? AND ? ORDER BY t.id"));
  row.bind_all(range.first, range.last);
  while (row.step()) visit(layout.read(row));
}
void MapStore::visit_rejected(const std::function<void(Observation&&)>& visit) const {
  with_map_name(path(), [&] {
    visit_evidence(connection_->database, types(), "WHERE o.rejected IS NOT NULL", {}, visit);
  });
}
void MapStore::visit_observations(std::string_view type, const RowRange& range,
                                  const std::function<void(Observation&&)>& visit) const {
  const std::string& table = connection_->table(type).layout.type().name;
  const std::string where = substitute_keys(
      R"(WHERE o.rejected IS NULL AND o.id IN (SELECT related_id FROM "{t}_observation" WHERE base_id BETWEEN {a} AND {b}))",
      {{"t", table}, {"a", std::to_string(range.first)}, {"b", std::to_string(range.last)}});
  with_map_name(path(), [&] { visit_evidence(connection_->database, types(), where, {}, visit); });
}
void MapStore::visit_observations(const std::function<void(Observation&&)>& visit) const {
  with_map_name(path(), [&] { visit_evidence(connection_->database, types(), "", {}, visit); });
}
void MapStore::visit_observations(std::string_view type, const MapQuery::Box& box,
                                  const std::function<void(Observation&&)>& visit) const {
  const std::string& table = connection_->table(type).layout.type().name;
  const std::string where =
      substitute_keys(R"(WHERE o.id IN (SELECT related_id FROM "{t}_observation" WHERE base_id IN ({rows})))",
                      {{"t", table}, {"rows", rows_in(table, box)}});
  with_map_name(path(), [&] { visit_evidence(connection_->database, types(), where, {}, visit); });
}
std::vector<ImageRecord> MapStore::images() const {
  return with_map_name(path(), [&] { return read_images(connection_->database); });
}
std::vector<RunRecord> MapStore::runs() const {
  return with_map_name(path(), [&] { return read_runs(connection_->database); });
}
bool MapStore::has_dem_coverage() const {
  return connection_->database.has_table("dem");
}

}  // namespace waymark::geodb
