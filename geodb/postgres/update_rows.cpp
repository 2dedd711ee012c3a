// SPDX-License-Identifier: Apache-2.0
#include "geodb/postgres/update_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "geodb/postgres/row_copy.hpp"

namespace waymark::geodb::postgres {
namespace {

std::vector<std::string> names(const sqlite::Database& map, const char* query) {
  std::vector<std::string> result;
  sqlite::Statement row = map.prepare(query);
  while (row.step()) result.emplace_back(row.text(0));
  return result;
}

/// Columns without the key.
std::vector<std::string> values_of(const TableLayout& table, std::string_view prefix) {
  std::vector<std::string> result;
  for (const Column& column : table.columns)
    if (column.name != table.key) result.push_back(std::string(prefix) + quoted(column.name));
  return result;
}

class Update {
 public:
  Update(const sqlite::Database& map, std::span<const TableLayout> tables, const Connection& server)
      : map_(&map), tables_(tables), server_(&server) {}

  void run() {
    stage("waymark_type");
    stage("waymark_feature");
    stage("waymark_attribute");
    stage("gpkg_geometry_columns");
    check_same("waymark_type");
    check_same("waymark_feature");
    check_same("waymark_attribute");
    check_same("gpkg_geometry_columns");
    const std::vector<std::string> types = names(*map_, "SELECT name FROM waymark_type ORDER BY id");
    for (const std::string& type : types) replace_rows(type, "uid");
    replace_rows("image", "name");
    add_rows("observation", {"uid", "source"});
    for (const std::string& type : types) link_evidence(type);
    add_rows("run", {"started"});
    std::set<std::string> copied{"dem", "gpkg_tile_matrix", "gpkg_tile_matrix_set",
                                 "gpkg_2d_gridded_coverage_ancillary", "gpkg_2d_gridded_tile_ancillary"};
    if (map_->has_table("waymark_layer"))
      for (const std::string& name : names(*map_, "SELECT name FROM waymark_layer")) copied.insert(name);
    for (const std::string& name : copied) copy_again(name);
    widen_extents();
  }

 private:
  const TableLayout* find(const std::string& name) const {
    const auto found = std::ranges::find(tables_, name, &TableLayout::name);
    return found == tables_.end() ? nullptr : &*found;
  }

  static std::string staged(const std::string& name) { return quoted("new_" + name); }

  void stage(const std::string& name) {
    server_->execute(
        fmt::format("CREATE TEMP TABLE {} (LIKE {}) ON COMMIT DROP", staged(name), quoted(name)));
    copy_rows(*map_, *find(name), *server_, staged(name));
  }

  void check_same(const std::string& name) {
    const std::string list = fmt::format("{}", fmt::join(values_of(*find(name), ""), ", "));
    if (server_->exists(fmt::format("(SELECT {0} FROM {1} EXCEPT SELECT {0} FROM {2}) UNION ALL "
                                    "(SELECT {0} FROM {2} EXCEPT SELECT {0} FROM {1})",
                                    list, staged(name), quoted(name))))
      throw Error(ErrorCode::input, "the schema holds a map of other landmark types, layers or CRS",
                  "table " + name, "export to another schema: add schema=NAME to the address");
  }

  /// Rows of the same `name` get the new values and keep their ids; the others are appended.
  void replace_rows(const std::string& table, const std::string& name) {
    const TableLayout& layout = *find(table);
    stage(table);
    server_->execute("ANALYZE " + staged(table));
    std::vector<std::string> set;
    for (const std::string& column : values_of(layout, "")) set.push_back(column + " = n." + column);
    server_->execute(fmt::format("UPDATE {0} o SET {1} FROM {2} n WHERE o.{3} = n.{3}", quoted(table),
                                 fmt::join(set, ", "), staged(table), name));
    server_->execute(fmt::format(
        "INSERT INTO {0} (id, {1}) SELECT coalesce((SELECT max(id) FROM {0}), (SELECT min(id) - 1 FROM {2})) "
        "+ row_number() OVER (ORDER BY n.id), {3} FROM {2} n "
        "WHERE NOT EXISTS (SELECT 1 FROM {0} o WHERE o.{4} = n.{4})",
        quoted(table), fmt::join(values_of(layout, ""), ", "), staged(table),
        fmt::join(values_of(layout, "n."), ", "), name));
  }

  /// Appends the rows that the schema lacks. `keys` are columns that differ in most rows.
  void add_rows(const std::string& table, const std::vector<std::string>& keys) {
    const TableLayout& layout = *find(table);
    stage(table);
    server_->execute("ANALYZE " + staged(table));
    std::string same;
    for (const std::string& key : keys)
      same += fmt::format("coalesce(o.{0}, '') = coalesce(n.{0}, '') AND ", key);
    server_->execute(fmt::format(
        "INSERT INTO {0} (id, {1}) SELECT coalesce((SELECT max(id) FROM {0}), 0) + row_number() OVER (ORDER "
        "BY "
        "n.id), {2} FROM {3} n WHERE NOT EXISTS (SELECT 1 FROM {0} o WHERE {4} ({5}) IS NOT DISTINCT FROM "
        "({2}))",
        quoted(table), fmt::join(values_of(layout, ""), ", "), fmt::join(values_of(layout, "n."), ", "),
        staged(table), same, fmt::join(values_of(layout, "o."), ", ")));
  }

  void link_evidence(const std::string& type) {
    const std::string link = quoted(type + "_observation");
    server_->execute("DELETE FROM " + link);
    server_->rows(
        fmt::format("INSERT INTO {} (row_number, base_id, related_id) SELECT row_number() OVER (ORDER BY "
                    "o.id), l.id, o.id FROM observation o JOIN {} l ON l.uid = o.uid "
                    "WHERE o.type = $1 AND o.rejected IS NULL",
                    link, quoted(type)),
        {type});
  }

  void copy_again(const std::string& name) {
    const TableLayout* layout = find(name);
    if (!layout) return;
    server_->execute("DELETE FROM " + quoted(name));
    copy_rows(*map_, *layout, *server_, quoted(name));
  }

  void widen_extents() {
    stage("gpkg_contents");
    server_->execute(
        "UPDATE gpkg_contents o SET min_x = least(o.min_x, n.min_x), min_y = least(o.min_y, n.min_y), max_x "
        "= "
        "greatest(o.max_x, n.max_x), max_y = greatest(o.max_y, n.max_y), last_change = "
        "greatest(o.last_change, "
        "n.last_change) FROM new_gpkg_contents n WHERE o.table_name = n.table_name");
  }

  const sqlite::Database* map_;
  std::span<const TableLayout> tables_;
  const Connection* server_;
};

}  // namespace

void update_rows(const sqlite::Database& map, std::span<const TableLayout> tables, const Connection& server) {
  Update(map, tables, server).run();
}

}  // namespace waymark::geodb::postgres
