// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
namespace waymark::geodb {

/// What was stored in PostgreSQL.
struct PostgresSummary {
  bool has_postgis = false;  ///< false: geometries are stored as bytes
  bool created = false;      ///< false: the schema held a map, which was updated
  std::int64_t landmarks = 0;
};

/// Stores a map in a schema of a PostgreSQL database: every table of the file, with PostGIS geometries if the
/// database has that extension. `address`: "pg:dbname=maps host=gis schema=alps", see
/// docs/how_to/use_postgis.md.
/// - One transaction: other sessions see the old content or the new one. Writers of one schema queue.
/// - A schema that holds a map is updated: landmarks and images replace those of the same uid or name,
///   evidence and runs that it lacks are added. Layers of shapes and elevation tiles are replaced.
/// - Throws Error{environment} without server or rights, Error{input} for a schema of another version or of
///   other landmark types, or with another CRS.
PostgresSummary export_to_postgres(const std::filesystem::path& map, const std::string& address);

/// Writes the map of a schema as a file, atomically. The file equals `VACUUM INTO` of the exported one byte
/// by byte. Spatial indexes of edited layers and geometries of other programs may differ. Throws
/// Error{environment} without server, Error{input} if the schema holds no map or one of another version.
void import_from_postgres(const std::string& address, const std::filesystem::path& map);

}  // namespace waymark::geodb
