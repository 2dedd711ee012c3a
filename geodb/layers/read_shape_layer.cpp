// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
#include "geodb/geopackage/shape_blob.hpp"
#include "geodb/layers/shape_table.hpp"
#include "geodb/open_map.hpp"
#include "geodb/sqlite/attribute_column.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

std::string unit_of(std::string_view title) {
  const std::size_t open = title.rfind(" (");
  return open == std::string_view::npos || !title.ends_with(')')
             ? ""
             : std::string(title.substr(open + 2, title.size() - open - 3));
}

std::vector<AttributeSpec> columns_of(const sqlite::Database& database, const std::string& table) {
  sqlite::Statement row = database.prepare(
      "SELECT t.name, t.type, coalesce(c.title, ''), coalesce(c.description, '') FROM pragma_table_info(?1) t"
      "  LEFT JOIN gpkg_data_columns c ON c.table_name = ?1 AND c.column_name = t.name"
      "  WHERE t.name NOT IN ('id', 'geom') ORDER BY t.cid");
  row.bind(1, table);
  std::vector<AttributeSpec> columns;
  while (row.step()) {
    const std::string_view type = row.text(1);
    const auto kind = type == "TEXT"      ? AttributeSpec::Kind::text
                      : type == "INTEGER" ? AttributeSpec::Kind::integer
                                          : AttributeSpec::Kind::real;
    columns.push_back({std::string(row.text(0)), unit_of(row.text(2)), kind, std::string(row.text(3))});
  }
  return columns;
}

void read_rows(const sqlite::Database& database, const ShapeLayer& layer,
               const std::optional<MapQuery::Box>& window, const std::function<void(Shape&&)>& visit) {
  std::string names = "geom";
  for (const AttributeSpec& column : layer.columns) names += ", " + quote_identifier(column.name);
  const std::string in_window =
      window ? fmt::format(
                   " WHERE id IN (SELECT id FROM {} WHERE maxx >= ? AND maxy >= ? AND minx <= ? AND "
                   "miny <= ?)",
                   quote_identifier("rtree_" + layer.name + "_geom"))
             : "";
  sqlite::Statement row = database.prepare(
      fmt::format("SELECT {} FROM {}{} ORDER BY id", names, quote_identifier(layer.name), in_window));
  if (window) row.bind_all(window->min_x, window->min_y, window->max_x, window->max_y);
  while (row.step()) {
    Shape shape;
    if (!row.null(0)) shape.parts = parts_of(row.blob(0));
    for (std::size_t i = 0; i < layer.columns.size(); ++i)
      shape.values.push_back(read_attribute(row, 1 + static_cast<int>(i), layer.columns[i].kind));
    visit(std::move(shape));
  }
}

}  // namespace

std::vector<ShapeLayer> declared_layers(const sqlite::Database& database) {
  std::vector<ShapeLayer> layers;
  if (!database.has_table("waymark_layer")) return layers;
  sqlite::Statement row = database.prepare("SELECT name, kind, summary FROM waymark_layer ORDER BY name");
  while (row.step()) {
    const auto kind = row.text(1) == "point"  ? ShapeKind::point
                      : row.text(1) == "line" ? ShapeKind::line
                                              : ShapeKind::polygon;
    ShapeLayer& layer = layers.emplace_back();
    layer.name = row.text(0);
    layer.summary = row.text(2);
    layer.kind = kind;
  }
  return layers;
}

std::vector<std::string> shape_layers(const std::filesystem::path& map) {
  const OpenMap open = open_for_reading(map);
  std::vector<std::string> names;
  for (const ShapeLayer& layer : declared_layers(open.database)) names.push_back(layer.name);
  return names;
}

void visit_shape_layer(const std::filesystem::path& map, std::string_view name,
                       const std::function<void(const ShapeLayer&)>& begin,
                       const std::function<void(Shape&&)>& visit,
                       const std::optional<MapQuery::Box>& window) {
  const OpenMap open = open_for_reading(map);
  std::vector<std::string> names;
  for (ShapeLayer& layer : declared_layers(open.database)) {
    names.push_back(layer.name);
    if (layer.name != name) continue;
    layer.columns = columns_of(open.database, layer.name);
    begin(layer);
    return read_rows(open.database, layer, window, visit);
  }
  throw Error(ErrorCode::input, fmt::format("this map has no layer '{}'", name), map.string(),
              names.empty() ? "it has landmarks only" : fmt::format("it has: {}", fmt::join(names, ", ")));
}

std::int64_t count_shapes(const std::filesystem::path& map, std::string_view name) {
  const OpenMap open = open_for_reading(map);
  const bool known = std::ranges::count(declared_layers(open.database), name, &ShapeLayer::name) > 0;
  return known ? open.database.integer("SELECT count(*) FROM " + quote_identifier(std::string(name))) : 0;
}

ShapeLayer read_shape_layer(const std::filesystem::path& map, std::string_view name) {
  ShapeLayer all;
  visit_shape_layer(
      map, name, [&](const ShapeLayer& layer) { all = layer; },
      [&](Shape&& shape) { all.rows.push_back(std::move(shape)); });
  return all;
}

}  // namespace waymark::geodb
