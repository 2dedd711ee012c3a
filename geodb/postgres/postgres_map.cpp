// SPDX-License-Identifier: Apache-2.0
#include "geodb/postgres/postgres_map.hpp"

#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/geopackage/migrations.hpp"
#include "geodb/layers/largest_index.hpp"
#include "geodb/open_map.hpp"
#include "geodb/postgres/connection.hpp"
#include "geodb/postgres/row_copy.hpp"
#include "geodb/postgres/update_rows.hpp"
#include "geodb/replace_map.hpp"
#include "geodb/rtree/box_order.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

using namespace postgres;

constexpr int kVersion = 1;  // of the tables of geodb/sql/postgres.sql
constexpr std::int64_t kFirstOwnSrid = 990'000, kLastOwnSrid = 998'998;

std::int64_t number(const Connection::Rows& rows) {
  return rows.empty() || !rows[0][0] ? 0 : std::stoll(*rows[0][0]);
}

/// Returns the SRID of a CRS, which is added to spatial_ref_sys if that lacks it, as it does those of other
/// bodies.
std::int64_t srid_of(const sqlite::Database& map, std::int64_t srs_id, const Connection& server) {
  if (srs_id <= 0) return 0;
  sqlite::Statement crs = map.prepare(
      "SELECT organization, organization_coordsys_id, definition, definition_12_063 FROM "
      "gpkg_spatial_ref_sys "
      "WHERE srs_id = ?");
  crs.bind(1, srs_id);
  if (!crs.step()) return 0;
  const std::string authority(crs.text(0)), code(crs.text(1));
  const std::string wkt(crs.text(2) == "undefined" ? crs.text(3) : crs.text(2));
  const bool named = authority == "EPSG" || authority.starts_with("IAU");
  const auto find = [&] {
    return named ? number(server.rows("SELECT srid FROM spatial_ref_sys WHERE auth_name = $1 AND auth_srid = "
                                      "$2::integer ORDER BY srid LIMIT 1",
                                      {authority, code}))
                 : number(server.rows(
                       "SELECT srid FROM spatial_ref_sys WHERE srtext = $1 ORDER BY srid LIMIT 1", {wkt}));
  };
  if (const std::int64_t srid = find()) return srid;
  server.execute("SELECT pg_advisory_xact_lock(hashtext('waymark spatial_ref_sys'))");
  if (const std::int64_t srid = find()) return srid;
  const std::int64_t srid =
      std::max(kFirstOwnSrid,
               1 + number(server.rows(fmt::format("SELECT max(srid) FROM spatial_ref_sys WHERE srid BETWEEN "
                                                  "{} AND {}",
                                                  kFirstOwnSrid, kLastOwnSrid))));
  server.rows(
      "INSERT INTO spatial_ref_sys (srid, auth_name, auth_srid, srtext, proj4text) VALUES ($1, $2, $3, $4, "
      "'')",
      {std::to_string(srid), authority, code, wkt});
  return srid;
}

SridMap srids_of(const sqlite::Database& map, const Connection& server) {
  SridMap srids;
  sqlite::Statement row = map.prepare("SELECT DISTINCT srs_id FROM gpkg_geometry_columns");
  while (row.step()) srids[row.integer(0)] = srid_of(map, row.integer(0), server);
  return srids;
}

void create_map(const sqlite::Database& map, const std::vector<TableLayout>& tables,
                const Connection& server) {
  server.execute(std::string(sql_text("postgres")));
  for (const TableLayout& table : tables) {
    server.execute(create_table(table));
    copy_rows(map, table, server, quoted(table.name));
    server.execute(fmt::format("ALTER TABLE {} ADD PRIMARY KEY ({})", quoted(table.name), quoted(table.key)));
    for (const Column& column : table.columns)
      if (column.kind == ValueKind::geometry)
        server.execute(
            fmt::format("CREATE INDEX ON {} USING gist ({})", quoted(table.name), quoted(column.name)));
  }
  sqlite::Statement type = map.prepare("SELECT name FROM waymark_type");
  while (type.step())
    server.execute(fmt::format("CREATE UNIQUE INDEX ON {} (uid)", quoted(std::string(type.text(0)))));
  server.execute("CREATE INDEX ON observation (uid); CREATE UNIQUE INDEX ON image (name)");
}

void store_definitions(const sqlite::Database& map, bool has_postgis, const Connection& server) {
  server.rows("INSERT INTO waymark_postgres SELECT $1::integer, $2::boolean, $3::bigint, $4::bigint",
              {std::to_string(kVersion), has_postgis ? "true" : "false",
               std::to_string(map.integer("PRAGMA page_size")),
               std::to_string(map.integer("PRAGMA schema_version"))});
  int position = 0;
  for (const Definition& definition : definitions(map)) {
    server.rows("INSERT INTO waymark_definition SELECT $1::integer, $2::text, $3::text, $4::text",
                {std::to_string(position++), definition.kind, definition.name, definition.sql});
    if (definition.kind == "view" && definition.name == "landmark") server.execute(definition.sql);
  }
}

void check_version(const Connection& server, const Address& address) {
  if (!server.exists("SELECT 1 FROM pg_tables WHERE schemaname = $1 AND tablename = 'waymark_postgres'",
                     {address.schema}))
    throw Error(ErrorCode::input, "the schema exists, but holds no map", "schema " + address.schema,
                "name another one: add schema=NAME to the address");
  const std::int64_t version = number(server.rows("SELECT version FROM waymark_postgres"));
  if (version != kVersion)
    throw Error(ErrorCode::input,
                fmt::format("the schema has version {}, this program supports version {}", version, kVersion),
                "schema " + address.schema, "use the Waymark that wrote it, or export to another schema");
}

void use_schema(const Connection& server, const Address& address) {
  // Extensions may live in any schema; `public` is the usual one.
  server.execute(fmt::format("SET LOCAL search_path = {}, public", quoted(address.schema)));
}

/// Runs one statement of the file's definitions, which are text from a database that others may write.
void define(const sqlite::Database& map, const std::string& sql) {
  for (const char* start : {"CREATE TABLE ", "CREATE INDEX ", "CREATE UNIQUE INDEX ", "CREATE VIEW ",
                            "CREATE TRIGGER ", "CREATE VIRTUAL TABLE "})
    if (sql.starts_with(start) &&
        (!sql.starts_with("CREATE VIRTUAL") || sql.find(" USING rtree(") != std::string::npos)) {
      map.prepare(sql).run();
      return;
    }
  throw Error(ErrorCode::input, "the schema's table waymark_definition holds a statement that no map has",
              sql.substr(0, 60), "export the map again");
}

bool is_rtree(std::string_view kind) {
  return kind == "row_rtree" || kind == "curve_rtree";
}

void fill_indexes(const sqlite::Database& map, const Connection::Rows& definitions) {
  for (const auto& row : definitions) {
    const std::string &kind = *row[0], layer = layer_of_index(*row[1]);
    if (!is_rtree(kind) || layer == "image") continue;  // that one is filled by its triggers, as in a new map
    if (kind == "row_rtree") {
      fill_rtree(map, layer);
    } else {
      std::vector<IndexedBox> boxes = boxes_of(map, layer);
      sort_along_curve(boxes);
      fill_rtree(map, layer, boxes);
    }
  }
}

/// Gives the definitions the order of the original file, which VACUUM retains.
void restore_order(const sqlite::Database& map, const Connection::Rows& definitions) {
  map.execute("PRAGMA writable_schema = ON; UPDATE sqlite_master SET rowid = rowid + 1000000");
  sqlite::Statement move = map.prepare("UPDATE sqlite_master SET rowid = ? WHERE name = ?");
  std::int64_t position = 0;
  for (const auto& row : definitions) {
    move.bind_all(++position, std::string_view(*row[1]));
    move.run();
  }
  map.execute("PRAGMA writable_schema = OFF");
}

void rebuild(const Connection& server, const sqlite::Database& map) {
  const Connection::Rows settings =
      server.rows("SELECT has_postgis, page_size, schema_cookie FROM waymark_postgres");
  const bool has_postgis = settings.at(0).at(0) == "t";
  map.execute(fmt::format("PRAGMA page_size = {}; PRAGMA application_id = {}; PRAGMA user_version = 10300",
                          std::stoll(*settings[0][1]), 0x47504B47));
  sqlite::Transaction all(map);
  const Connection::Rows definitions =
      server.rows("SELECT kind, name, sql FROM waymark_definition ORDER BY position");
  const auto is_early = [](const auto& row) {
    return row[0] == "table" || is_rtree(*row[0]) || (row[0] == "index" && is_largest_index(*row[1])) ||
           (row[0] == "trigger" && row[1]->starts_with("rtree_image_"));
  };
  for (const auto& row : definitions)
    if (is_early(row)) define(map, *row[2]);
  for (const char* name : {"gpkg_geometry_columns"})
    for (const TableLayout& table : table_layouts(map, {}))
      if (table.name == name) fetch_rows(server, table, map, 0);
  const std::int32_t srs_id = srs_id_of_map(map);
  SridMap known;
  sqlite::Statement id = map.prepare("SELECT DISTINCT srs_id FROM gpkg_geometry_columns");
  while (has_postgis && id.step()) known[id.integer(0)] = 0;
  for (const TableLayout& table : table_layouts(map, known)) {
    if (table.name == "gpkg_geometry_columns") continue;
    if (table.name == "sqlite_sequence") map.execute("DELETE FROM sqlite_sequence");
    fetch_rows(server, table, map, srs_id);
  }
  // Rows added to tables with AUTOINCREMENT after sqlite_sequence was filled have changed it.
  for (const TableLayout& table : table_layouts(map, known))
    if (table.name == "sqlite_sequence") {
      map.execute("DELETE FROM sqlite_sequence");
      fetch_rows(server, table, map, srs_id);
    }
  fill_indexes(map, definitions);
  for (const auto& row : definitions)
    if (!is_early(row) && row[0] != "rtree_part") define(map, *row[2]);
  restore_order(map, definitions);
  all.commit();
  map.execute(fmt::format("PRAGMA schema_version = {}", std::stoll(*settings[0][2]) - 1));  // VACUUM adds one
}

}  // namespace

PostgresSummary export_to_postgres(const std::filesystem::path& path, const std::string& text) {
  const Address address = parse_address(text);
  const OpenMap map = open_for_reading(path);
  const Connection server(address);
  server.execute("BEGIN");
  // Writers of one schema queue until the transaction ends.
  server.rows("SELECT pg_advisory_xact_lock(hashtext('waymark'), hashtext($1))", {address.schema});
  PostgresSummary summary;
  summary.created = !server.exists("SELECT 1 FROM pg_namespace WHERE nspname = $1", {address.schema});
  summary.has_postgis = server.exists("SELECT 1 FROM pg_extension WHERE extname = 'postgis'");
  if (summary.created) server.execute("CREATE SCHEMA " + quoted(address.schema));
  use_schema(server, address);
  if (!summary.created) {
    check_version(server, address);
    summary.has_postgis = server.exists("SELECT 1 FROM waymark_postgres WHERE has_postgis");
  }
  const SridMap srids = summary.has_postgis ? srids_of(map.database, server) : SridMap{};
  const std::vector<TableLayout> tables = table_layouts(map.database, srids);
  with_map_name(path, [&] {
    if (summary.created) {
      create_map(map.database, tables, server);
      store_definitions(map.database, summary.has_postgis, server);
    } else {
      update_rows(map.database, tables, server);
    }
  });
  server.execute("COMMIT");
  sqlite::Statement type = map.database.prepare("SELECT name FROM waymark_type");
  while (type.step())
    summary.landmarks +=
        map.database.integer("SELECT count(*) FROM " + quote_identifier(std::string(type.text(0))));
  return summary;
}

void import_from_postgres(const std::string& text, const std::filesystem::path& path) {
  const Address address = parse_address(text);
  const Connection server(address);
  server.execute("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY");
  use_schema(server, address);
  if (!server.exists("SELECT 1 FROM pg_namespace WHERE nspname = $1", {address.schema}))
    throw Error(ErrorCode::input, "there is no such schema", "schema " + address.schema,
                "`waymark export MAP pg:...` makes it; schema=NAME in the address names another");
  check_version(server, address);
  AtomicFile file(path);
  try {
    const std::filesystem::path loose = file.path().string() + ".loose";
    const sqlite::Database map = sqlite::scratch_database(loose);
    rebuild(server, map);
    sqlite::Statement compact = map.prepare("VACUUM INTO ?");
    const std::string target = file.path().string();
    compact.bind(1, std::string_view(target));
    compact.run();
    open_for_reading(file.path());
  } catch (const Error& e) {
    throw with_final_path(e, file.path(), path);
  }
  server.execute("COMMIT");
  replace_map(file);
}

}  // namespace waymark::geodb
