// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include "geodb/sqlite.hpp"
namespace waymark {

/// Version of the schema this program writes (sql/schema.sql).
inline constexpr int kSchemaVersion = 2;

/// Marks a new file as a GeoPackage 1.3 and as a map of kSchemaVersion, and creates the fixed tables.
void create_schema(const sqlite::Database& database, std::string_view changed);

/// Version of a map. Throws Error where the file is not a GeoPackage, is one that is not a map of ours, or is
/// a map of a version this program does not know yet.
int schema_version(const sqlite::Database& database);

/// Brings an older map to kSchemaVersion, all steps (sql/migrate_<version>.sql) or none.
void migrate(const sqlite::Database& database);

}  // namespace waymark
