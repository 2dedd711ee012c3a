// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/migrations.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/error.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

constexpr std::int64_t kGeoPackage = 0x47504B47;  // "GPKG", SQLite's application_id

void migrate_types_to_3(const sqlite::Database& database) {
  std::vector<std::string> types;
  sqlite::Statement type = database.prepare("SELECT name FROM waymark_type ORDER BY id");
  while (type.step()) types.emplace_back(type.text(0));
  for (const std::string& name : types) {
    if (!database.has_table(name)) continue;  // validate reports it
    std::string unknown;
    sqlite::Statement feature = database.prepare("SELECT name FROM waymark_feature WHERE type = ?");
    feature.bind(1, name);
    while (feature.step())
      unknown += " AND " + quote_identifier(std::string(feature.text(0)) + "_q") + " IS NULL";
    database.execute(substitute_keys(sql_text("migrate_3_type"), {{"t", name}, {"unknown", unknown}}));
    create_edit_triggers(database, name);
  }
}

}  // namespace

void create_schema(const sqlite::Database& database, std::string_view changed) {
  database.execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = 10300", kGeoPackage));
  database.execute(substitute_keys(sql_text("schema"), {{"time", changed}}));
  sqlite::Statement version = database.prepare("INSERT INTO waymark_schema VALUES (?, 'created')");
  version.bind(1, kSchemaVersion);
  version.run();
}

int schema_version(const sqlite::Database& database) {
  if (database.integer("PRAGMA application_id") != kGeoPackage || !database.has_table("gpkg_contents"))
    throw Error(ErrorCode::input, "this is not a GeoPackage", "",
                "a map is made by `waymark run` or `waymark peaks`");
  if (!database.has_table("waymark_schema"))
    throw Error(ErrorCode::input, "this GeoPackage is not a Waymark map: it has no table waymark_schema", "",
                "a map is made by `waymark run` or `waymark peaks`");
  const auto version = static_cast<int>(database.integer("SELECT max(version) FROM waymark_schema"));
  if (version > kSchemaVersion)
    throw Error(ErrorCode::input,
                fmt::format("this map has schema version {}, this program supports up to {}", version,
                            kSchemaVersion),
                "", "use a newer Waymark");
  if (version < 1)
    throw Error(ErrorCode::input, "the map's schema version is missing", "table waymark_schema");
  return version;
}

void migrate(const sqlite::Database& database) {
  sqlite::Transaction all(database);
  for (int version = schema_version(database) + 1; version <= kSchemaVersion; ++version) {
    database.execute(sql_text(fmt::format("migrate_{}", version)));
    if (version == 3) migrate_types_to_3(database);
  }
  all.commit();
}

}  // namespace waymark::geodb
