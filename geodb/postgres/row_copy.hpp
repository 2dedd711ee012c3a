// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geodb/postgres/connection.hpp"
#include "geodb/postgres/table_layout.hpp"
namespace waymark::geodb::postgres {

/// Copies all rows of a table of the map file into a table of PostgreSQL with the same columns.
/// Throws Error{input} for a geometry that is not one. About 1 us per value.
void copy_rows(const sqlite::Database& map, const TableLayout& table, const Connection& server,
               const std::string& target);

/// Copies all rows of a table of PostgreSQL into the map file, in the order of its key. `srs_id` is given to
/// its geometries.
void fetch_rows(const Connection& server, const TableLayout& table, const sqlite::Database& map,
                std::int32_t srs_id);

}  // namespace waymark::geodb::postgres
