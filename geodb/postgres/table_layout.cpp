// SPDX-License-Identifier: Apache-2.0
#include "geodb/postgres/table_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "geodb/rtree/packed_rtree.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb::postgres {
namespace {

std::string upper(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

// As SQLite decides which values a column prefers (datatype3.html, 3.1), with dates as texts. Texts compare
// by bytes, as in SQLite; by the rules of a language an index takes twice as long.
Column column_of(const std::string& name, std::string_view declared) {
  const std::string type = upper(declared);
  const auto has = [&](const char* word) { return type.find(word) != std::string::npos; };
  if (has("POINT") || has("LINESTRING") || has("POLYGON") || has("BLOB"))
    return {name, ValueKind::bytes, "bytea"};
  if (has("INT") || has("BOOL")) return {name, ValueKind::integer, "bigint"};
  if (has("REAL") || has("DOUB") || has("FLOA") || has("NUMERIC"))
    return {name, ValueKind::real, "double precision"};
  if (name == "seq") return {name, ValueKind::integer, "bigint"};  // of sqlite_sequence, which has no types
  return {name, ValueKind::text, "text COLLATE \"C\""};
}

void make_geometry(const sqlite::Database& map, const SridMap& srids, TableLayout& table) {
  sqlite::Statement layer = map.prepare(
      "SELECT column_name, geometry_type_name, z, srs_id FROM gpkg_geometry_columns WHERE table_name = ?");
  layer.bind(1, table.name);
  if (!layer.step()) return;
  for (Column& column : table.columns) {
    if (column.name != layer.text(0)) continue;
    const std::int64_t srid = srids.at(layer.integer(3));
    column.kind = ValueKind::geometry;
    column.sql_type =
        fmt::format("geometry({}{}, {})", layer.text(1), layer.integer(2) == 1 ? "Z" : "", srid);
  }
}

TableLayout layout_of(const sqlite::Database& map, const std::string& name, const SridMap& srids) {
  TableLayout table{.name = name, .columns = {}, .key = "row_number", .has_row_number = true};
  sqlite::Statement column = map.prepare("SELECT name, type, pk FROM pragma_table_info(?)");
  column.bind(1, name);
  while (column.step()) {
    table.columns.push_back(column_of(std::string(column.text(0)), column.text(1)));
    if (column.integer(2) != 1 || upper(column.text(1)) != "INTEGER") continue;
    table.key = column.text(0);
    table.has_row_number = false;
  }
  if (!srids.empty()) make_geometry(map, srids, table);
  return table;
}

bool is_of_spatial_index(std::string_view name) {
  return name.starts_with("rtree_");
}

std::string kind_of(const sqlite::Database& map, const std::string& kind, const std::string& name,
                    const std::string& sql) {
  if (kind != "table" || !is_of_spatial_index(name)) return kind;
  if (!sql.starts_with("CREATE VIRTUAL")) return "rtree_part";
  return has_row_order(map, layer_of_index(name)) ? "row_rtree" : "curve_rtree";
}

}  // namespace

std::string layer_of_index(std::string_view index) {
  constexpr std::string_view begin = "rtree_", end = "_geom";
  if (index.starts_with(begin)) index.remove_prefix(begin.size());
  if (index.ends_with(end)) index.remove_suffix(end.size());
  return std::string(index);
}

std::vector<TableLayout> table_layouts(const sqlite::Database& map, const SridMap& srids) {
  std::vector<TableLayout> tables;
  sqlite::Statement name = map.prepare("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY rowid");
  while (name.step())
    if (!is_of_spatial_index(name.text(0)))
      tables.push_back(layout_of(map, std::string(name.text(0)), srids));
  return tables;
}

std::vector<Definition> definitions(const sqlite::Database& map) {
  std::vector<Definition> all;
  sqlite::Statement row =
      map.prepare("SELECT type, name, sql FROM sqlite_master WHERE sql NOT NULL ORDER BY rowid");
  while (row.step()) {
    const std::string kind(row.text(0)), name(row.text(1)), sql(row.text(2));
    if (!name.starts_with("sqlite_")) all.push_back({kind_of(map, kind, name, sql), name, sql});
  }
  return all;
}

std::string quoted(const std::string& name) {
  std::string lower = name;
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return quote_identifier(lower);
}

std::string column_list(const TableLayout& table) {
  std::string list = table.has_row_number ? "row_number" : "";
  for (const Column& column : table.columns) list += (list.empty() ? "" : ", ") + quoted(column.name);
  return list;
}

std::string create_table(const TableLayout& table) {
  std::string columns = table.has_row_number ? "row_number bigint" : "";
  for (const Column& column : table.columns)
    columns += (columns.empty() ? "" : ", ") + quoted(column.name) + " " + column.sql_type;
  return fmt::format("CREATE TABLE {} ({})", quoted(table.name), columns);
}

}  // namespace waymark::geodb::postgres
