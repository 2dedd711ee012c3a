// SPDX-License-Identifier: Apache-2.0
#pragma once
struct sqlite3;
namespace waymark {

/// Gives a connection ST_IsEmpty, ST_MinX, ST_MaxX, ST_MinY and ST_MaxY of GeoPackage geometries, which the
/// triggers of every spatial index call. Of anything that is no geometry they give NULL.
void add_geometry_functions(sqlite3* database);

}  // namespace waymark
