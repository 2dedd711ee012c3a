// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_store.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "geodb/crs_table.hpp"
#include "geodb/evidence.hpp"
#include "geodb/map_connection.hpp"
#include "geodb/provenance.hpp"
#include "geodb/sql_text.hpp"
#include "geodb/type_catalogue.hpp"

namespace waymark {
namespace {

// The map's CRS is that of its images, a table every map has.
std::int32_t srs_id_of_map(const sqlite::Database& database) {
  return static_cast<std::int32_t>(
      database.integer("SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = 'image'"));
}

Envelope extent_of_map(const sqlite::Database& database) {
  sqlite::Statement row = database.prepare(
      "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'landmark' AND min_x NOT "
      "NULL");
  if (!row.step()) return {};
  return {row.real(0), row.real(1), row.real(2), row.real(3)};
}

std::string box_condition(const std::string& table) {
  return fill_in(
      R"(JOIN "rtree_{t}_geom" r ON r.id = t.id WHERE r.maxx >= ?1 AND r.maxy >= ?2 AND r.minx <= ?3 AND r.miny <= ?4)",
      {{"t", table}});
}

std::string rows_in(const std::string& table, const MapQuery::Box& box) {
  return fmt::format(
      "SELECT id FROM {} WHERE maxx >= {:.17g} AND maxy >= {:.17g} AND minx <= {:.17g} AND miny <= {:.17g}",
      sql_name("rtree_" + table + "_geom"), box.min_x, box.min_y, box.max_x, box.max_y);
}

bool bounded(const SearchWindows& windows) {
  return windows.size() > 1 || std::isfinite(windows[0].min_x) || std::isfinite(windows[0].min_y);
}

}  // namespace

LandmarkTable::LandmarkTable(const sqlite::Database& database, const LandmarkType& type, TypeId id)
    : layout(type, id),
      all(database.prepare(layout.select("ORDER BY t.id"))),
      in_box(database.prepare(layout.select(box_condition(type.name)))),
      of_uid(database.prepare(layout.select("WHERE t.uid = ?"))) {}

MapStore::Connection::Connection(std::filesystem::path file, OpenMap map)
    : path(std::move(file)),
      database(std::move(map.database)),
      version(map.version),
      types(read_types(database)),
      srs_id(srs_id_of_map(database)),
      crs(read_crs(database, srs_id)),
      ruler(crs),
      extent(extent_of_map(database)) {
  for (TypeId id = 0; id < types.size(); ++id) tables.emplace_back(database, types[id], id);
}

void MapStore::Connection::visit(LandmarkTable& table, const SearchWindows& windows, const Visit& visit) {
  const bool boxes = bounded(windows);
  sqlite::Statement& rows = boxes ? table.in_box : table.all;
  for (const MapQuery::Box& window : windows) {
    if (boxes) rows.bind_all(window.min_x, window.min_y, window.max_x, window.max_y);
    while (rows.step()) visit(rows);
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

std::optional<MapStore::Connection::Found> MapStore::Connection::find(std::string_view uid) {
  for (LandmarkTable& table : tables) {
    table.of_uid.bind(1, uid);
    if (!table.of_uid.step()) continue;
    Found found{LandmarkLayout::row_id(table.of_uid), &table, table.layout.read(table.of_uid)};
    table.of_uid.reset();
    return found;
  }
  return std::nullopt;
}

MapStore MapStore::open(const std::filesystem::path& path) {
  return MapStore(std::make_unique<Connection>(path, open_for_reading(path)));
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
  return connection_->database.integer("SELECT count(*) FROM " + sql_name(table));
}

std::optional<Landmark> MapStore::find(std::string_view uid) const {
  auto found = connection_->find(uid);
  if (!found) return std::nullopt;
  return std::move(found->landmark);
}

double MapStore::distance(const Landmark& landmark, double x, double y) const {
  const auto& at = landmark.position.xyz;
  return connection_->ruler(x, y, at.x(), at.y());
}

std::vector<Observation> MapStore::observations_of(std::string_view uid) const {
  return read_evidence(connection_->database, types(), "WHERE o.uid = ? AND o.rejected IS NULL", uid);
}
std::vector<Observation> MapStore::observations() const {
  return read_evidence(connection_->database, types(), "");
}
void MapStore::visit(std::string_view type, const std::function<void(Landmark&&)>& visit) const {
  LandmarkTable& table = connection_->table(type);
  connection_->visit(table, everywhere(),
                     [&](const sqlite::Statement& row) { visit(table.layout.read(row)); });
}
void MapStore::visit(std::string_view type, const MapQuery::Box& box,
                     const std::function<void(Landmark&&)>& visit) const {
  const LandmarkLayout& layout = connection_->table(type).layout;
  sqlite::Statement row = connection_->database.prepare(
      layout.select("WHERE t.id IN (" + rows_in(layout.type().name, box) + ") ORDER BY t.id"));
  while (row.step()) {
    Landmark landmark = layout.read(row);
    const auto& at = landmark.position.xyz;  // boxes of the index are rounded outwards
    if (at.x() >= box.min_x && at.x() <= box.max_x && at.y() >= box.min_y && at.y() <= box.max_y)
      visit(std::move(landmark));
  }
}
void MapStore::visit_observations(const std::function<void(Observation&&)>& visit) const {
  visit_evidence(connection_->database, types(), "", {}, visit);
}
void MapStore::visit_observations(std::string_view type, const MapQuery::Box& box,
                                  const std::function<void(Observation&&)>& visit) const {
  const std::string& table = connection_->table(type).layout.type().name;
  const std::string where =
      fill_in(R"(WHERE o.id IN (SELECT related_id FROM "{t}_observation" WHERE base_id IN ({rows})))",
              {{"t", table}, {"rows", rows_in(table, box)}});
  visit_evidence(connection_->database, types(), where, {}, visit);
}
std::vector<ImageRecord> MapStore::images() const {
  return read_images(connection_->database);
}
std::vector<RunRecord> MapStore::runs() const {
  return read_runs(connection_->database);
}
bool MapStore::has_dem_coverage() const {
  return connection_->database.has_table("dem");
}

}  // namespace waymark
