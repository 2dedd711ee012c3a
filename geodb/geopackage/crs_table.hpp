// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/crs.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Stores `crs` and the three mandatory definitions of a GeoPackage, and returns the srs_id of `crs`. It is
/// the EPSG code, 100000 for any other authority or none, -1 ("undefined Cartesian") for a local CRS. WKT 2
/// is stored in definition_12_063, the only definition of planetary CRSs that QGIS accepts.
std::int32_t write_crs(const sqlite::Database& database, const Crs& crs);

/// Reads a CRS by authority and code if PROJ knows them, else by definition. Throws Error if PROJ knows
/// neither.
Crs read_crs(const sqlite::Database& database, std::int32_t srs_id);

}  // namespace waymark::geodb
