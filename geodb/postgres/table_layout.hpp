// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb::postgres {

/// SRIDs of PostgreSQL by srs_id of the map file.
using SridMap = std::map<std::int64_t, std::int64_t>;

/// How the values of a column are stored in PostgreSQL.
enum class ValueKind { integer, real, text, bytes, geometry };

struct Column {
  std::string name;  ///< in the map file; lower case in PostgreSQL
  ValueKind kind;
  std::string sql_type;  ///< in PostgreSQL
};

/// One table of a map in both databases.
struct TableLayout {
  std::string name;
  std::vector<Column> columns;
  /// Column that orders the rows: the integer key, or `row_number`, which only PostgreSQL has.
  std::string key;
  bool has_row_number = false;
};

/// Object of sqlite_master.
struct Definition {
  /// table, index, view, trigger; of spatial indexes: row_rtree and curve_rtree, filled in the order of the
  /// rows or along a Hilbert curve, and rtree_part, made with it.
  std::string kind;
  std::string name, sql;
};

/// Returns the layouts of the tables in the order of their definitions, without those of spatial indexes.
/// Columns of registered layers are geometries if `srids` has the SRID of their srs_id; it is empty without
/// PostGIS.
std::vector<TableLayout> table_layouts(const sqlite::Database& map, const SridMap& srids);
/// Returns the table that the RTree "rtree_<table>_geom" indexes.
std::string layer_of_index(std::string_view index);
std::vector<Definition> definitions(const sqlite::Database& map);

std::string create_table(const TableLayout& table);
/// Returns the columns in PostgreSQL, quoted and separated by commas.
std::string column_list(const TableLayout& table);
/// Returns a name of PostgreSQL: lower case and quoted.
std::string quoted(const std::string& name);

}  // namespace waymark::geodb::postgres
