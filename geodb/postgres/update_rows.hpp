// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "geodb/postgres/connection.hpp"
#include "geodb/postgres/table_layout.hpp"
namespace waymark::geodb::postgres {

/// Adds a map to the map of the schema, within the caller's transaction; see export_to_postgres().
/// Throws Error{input} if the schema's landmark types or CRS differ.
void update_rows(const sqlite::Database& map, std::span<const TableLayout> tables, const Connection& server);

}  // namespace waymark::geodb::postgres
