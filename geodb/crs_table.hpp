// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/crs.hpp"
#include "geodb/sqlite.hpp"
namespace waymark {

/// Stores `crs`, with the three definitions every GeoPackage has, and gives its srs_id: the EPSG code, 100000
/// for a CRS of any other authority or none, -1 ("undefined Cartesian") for a local one. WKT 2 goes to
/// definition_12_063: for the planets it is the only definition QGIS accepts.
std::int32_t write_crs(const sqlite::Database& database, const Crs& crs);

/// By authority and code where PROJ knows them, else by definition. Throws Error where PROJ knows neither.
Crs read_crs(const sqlite::Database& database, std::int32_t srs_id);

}  // namespace waymark
