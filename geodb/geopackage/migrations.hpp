// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Version of the schema this program writes (sql/schema.sql).
inline constexpr int kSchemaVersion = 3;

/// Marks a new file as a GeoPackage 1.3 and as a map of kSchemaVersion, and creates the fixed tables.
void create_schema(const sqlite::Database& database, std::string_view changed);

/// Returns the schema version of a map. Throws Error if the file is not a GeoPackage, not a Waymark map, or
/// of a newer version.
int schema_version(const sqlite::Database& database);

/// Migrates an older map to kSchemaVersion, by all steps (sql/migrate_<version>.sql) or none.
void migrate(const sqlite::Database& database);

}  // namespace waymark::geodb
