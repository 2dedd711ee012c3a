// SPDX-License-Identifier: Apache-2.0
#pragma once
struct sqlite3;
namespace waymark::geodb {

/// Registers ST_IsEmpty, ST_MinX, ST_MaxX, ST_MinY and ST_MaxY of GeoPackage geometries, which the triggers
/// of spatial indexes call. They return NULL for any other value.
void add_geometry_functions(sqlite3* database);

}  // namespace waymark::geodb
