// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/migrations.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/error.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/sqlite/sql_text.hpp"
#include "landmarks/landmark_type.hpp"

namespace waymark::geodb {
namespace {

constexpr std::int64_t kGeoPackage = 0x47504B47;  // "GPKG", SQLite's application_id

// Maps of version 2 do not say how their types are seen. Types unknown to this program keep what drawing and
// size meant before: bowls were craters, and a size called radius or diameter was that of the body.
void declare_types(const sqlite::Database& database) {
  TypeRegistry built_in;
  register_landmark_types(built_in);
  sqlite::Statement set = database.prepare(
      "UPDATE waymark_type SET evidence = ?, body_feature = ?, radius_per_value = ?,"
      "  identification_reach = ?, identifies_itself = ? WHERE id = ?");
  sqlite::Statement row = database.prepare("SELECT id, name, drawn_as, size_feature FROM waymark_type");
  while (row.step()) {
    LandmarkType type;
    if (const LandmarkType* known = built_in.find(row.text(1))) {
      type = *known;
    } else {
      const std::string size(row.text(3));
      if (row.text(2) == "bowl") type.evidence = EvidenceModel::bowl;
      if (size == "radius") type.body = {size, 1};
      if (size.ends_with("diameter")) type.body = {size, 0.5};
    }
    set.bind_all(to_string(type.evidence), type.body.feature, type.body.radius_per_value,
                 type.identification_reach, static_cast<int>(type.identifies_itself), row.integer(0));
    set.run();
  }
}

void migrate_types_to_3(const sqlite::Database& database) {
  declare_types(database);
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
