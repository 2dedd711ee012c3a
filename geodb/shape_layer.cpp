// SPDX-License-Identifier: Apache-2.0
#include "geodb/shape_layer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/geopackage/provenance.hpp"
#include "geodb/geopackage/shape_blob.hpp"
#include "geodb/layers/shape_table.hpp"
#include "geodb/open_map.hpp"
#include "geodb/rtree/box_order.hpp"
#include "geodb/rtree/packed_rtree.hpp"
#include "geodb/sqlite/attribute_column.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

[[noreturn]] void refuse(const std::string& problem, const std::string& where, const char* hint) {
  throw Error(ErrorCode::input, problem, where, hint);
}

bool is_name(std::string_view name) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && letter(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return letter(c) || c == '_' || (c >= '0' && c <= '9'); });
}

void check_names(const ShapeLayer& layer) {
  if (!is_name(layer.name))
    refuse("'" + layer.name + "' is not a valid layer name", "", "use a-z, 0-9 and _, a letter first");
  std::set<std::string> names{"id", "geom"};
  for (const AttributeSpec& column : layer.columns)
    if (!is_name(column.name) || !names.insert(column.name).second)
      refuse("layer " + layer.name + " cannot have a column '" + column.name + "'", "",
             "use a-z, 0-9 and _, each name once; id and geom are reserved");
}

void check_row(const ShapeLayer& layer, const Shape& shape, std::size_t row) {
  const std::string where = fmt::format("layer {}, row {}", layer.name, row + 1);
  const char* hint = "check the source of the shapes";
  if (shape.values.size() != layer.columns.size())
    refuse(fmt::format("a shape has {} values for {} columns", shape.values.size(), layer.columns.size()),
           where, hint);
  const std::size_t min_corners = layer.kind == ShapeKind::point ? 1 : layer.kind == ShapeKind::line ? 2 : 3;
  const auto check_ring = [&](const std::vector<Eigen::Vector2d>& ring) {
    if (ring.size() < min_corners || (layer.kind == ShapeKind::point && ring.size() > 1))
      refuse(fmt::format("a part of a shape has {} corners", ring.size()), where, hint);
    for (const auto& corner : ring)
      if (!corner.allFinite()) refuse("a corner of a shape is not finite", where, hint);
  };
  if (layer.kind == ShapeKind::point && shape.parts.size() > 1)
    refuse("a point has several parts", where, hint);
  for (const ShapePart& part : shape.parts) {
    check_ring(part.outer);
    for (const auto& hole : part.holes) check_ring(hole);
  }
}

void remove_layer(const sqlite::Database& database, const std::string& name) {
  if (database.has_table(name))
    database.execute(substitute_keys(
        R"(DROP TABLE IF EXISTS "rtree_{t}_geom"; DROP TABLE "{t}";
           DELETE FROM gpkg_extensions WHERE table_name = '{t}'; DELETE FROM gpkg_data_columns WHERE table_name = '{t}';
           DELETE FROM gpkg_geometry_columns WHERE table_name = '{t}'; DELETE FROM layer_styles WHERE f_table_name = '{t}';
           DELETE FROM gpkg_contents WHERE table_name = '{t}'; DELETE FROM waymark_layer WHERE name = '{t}';)",
        {{"t", name}}));
}

// Created with the first layer, so that maps without layers do not change.
void create_catalogue(const sqlite::Database& database) {
  if (database.has_table("waymark_layer")) return;
  database.execute(
      "CREATE TABLE waymark_layer (\n"
      "  name TEXT NOT NULL PRIMARY KEY,   -- of the table\n"
      "  kind TEXT NOT NULL,               -- point, line, polygon\n"
      "  summary TEXT NOT NULL\n);\n"
      "INSERT INTO gpkg_extensions VALUES ('waymark_layer', NULL, 'waymark_map', 'docs/map.md of Waymark', "
      "'read-write')");
}

void reserve_name(const sqlite::Database& database, const ShapeLayer& layer) {
  create_catalogue(database);
  sqlite::Statement ours = database.prepare("SELECT 1 FROM waymark_layer WHERE name = ?");
  ours.bind(1, layer.name);
  const bool known = ours.step();
  ours.reset();
  bool reserved = false;
  for (const char* prefix : {"gpkg", "rtree_", "sqlite_", "waymark_"})
    reserved = reserved || layer.name.starts_with(prefix);
  if (known) return remove_layer(database, layer.name);
  if (reserved || database.has_table(layer.name))
    refuse("a map cannot have a layer '" + layer.name + "': that name is taken", "", "choose another name");
}

void create_table(const sqlite::Database& database, const ShapeLayer& layer) {
  std::string columns;
  for (const AttributeSpec& column : layer.columns)
    columns += fmt::format(",\n  {} {}", quote_identifier(column.name), sql_type(column.kind));
  database.execute(fmt::format("CREATE TABLE {} (\n  id INTEGER PRIMARY KEY,\n  geom {}{}\n)",
                               quote_identifier(layer.name), geometry_name(layer.kind), columns));
}

Envelope insert_rows(const sqlite::Database& database, const ShapeLayer& layer, std::int32_t srs_id) {
  std::string placeholders = "?, ?";
  for (std::size_t i = 0; i < layer.columns.size(); ++i) placeholders += ", ?";
  sqlite::Statement insert =
      database.prepare(fmt::format("INSERT INTO {} VALUES ({})", quote_identifier(layer.name), placeholders));
  Envelope extent;
  std::vector<IndexedBox> boxes;
  std::int64_t row = 0;
  const auto add = [&](const Shape& shape) {
    check_row(layer, shape, static_cast<std::size_t>(row++));
    const std::vector<std::byte> blob = shape_blob(layer.kind, shape.parts, srs_id);
    insert.bind(1, row);
    insert.bind(2, nullptr);
    if (!shape.parts.empty()) insert.bind(2, std::span<const std::byte>(blob));
    for (std::size_t c = 0; c < layer.columns.size(); ++c)
      bind_attribute(insert, 3 + static_cast<int>(c), shape.values[c]);
    insert.run();
    if (shape.parts.empty()) return;
    const Envelope box = envelope_of(shape.parts);
    extent.add(box);
    if (!layer.generator) boxes.push_back({row, box.min_x, box.max_x, box.min_y, box.max_y});
  };
  std::ranges::for_each(layer.rows, add);
  if (layer.generator) layer.generator(add);
  create_spatial_index(database, layer.name);
  if (layer.generator) {
    fill_rtree(database, layer.name);
  } else {
    sort_along_curve(boxes);
    fill_rtree(database, layer.name, boxes);
  }
  return extent;
}

void describe(const sqlite::Database& database, const ShapeLayer& layer, std::string_view changed) {
  sqlite::Statement column =
      database.prepare("INSERT INTO gpkg_data_columns VALUES (?, ?, ?, ?, ?, NULL, NULL)");
  for (const AttributeSpec& c : layer.columns) {
    const std::string title = c.unit.empty() ? c.name : c.name + " (" + c.unit + ")";  // bound, not copied
    column.bind_all(layer.name, c.name, c.name, title, c.summary);
    column.run();
  }
  store_style(database, layer.name, qml_shape_style(layer), sld_shape_style(layer), layer.summary, changed);
  sqlite::Statement declare = database.prepare("INSERT INTO waymark_layer VALUES (?, ?, ?)");
  const char* kinds[] = {"point", "line", "polygon"};
  declare.bind_all(layer.name, std::string_view(kinds[static_cast<int>(layer.kind)]), layer.summary);
  declare.run();
}

}  // namespace

const char* geometry_name(ShapeKind kind) {
  return kind == ShapeKind::point ? "POINT" : kind == ShapeKind::line ? "MULTILINESTRING" : "MULTIPOLYGON";
}

void write_layers(const sqlite::Database& database, std::span<const ShapeLayer> layers,
                  std::string_view changed) {
  const std::int32_t srs_id = srs_id_of_map(database);
  for (const ShapeLayer& layer : layers) {
    check_names(layer);
    reserve_name(database, layer);
    create_table(database, layer);
    const Envelope extent = insert_rows(database, layer, srs_id);
    register_layer(database, {.table = layer.name,
                              .description = layer.summary,
                              .geometry_type = geometry_name(layer.kind),
                              .extent = extent,
                              .srs_id = srs_id,
                              .changed = std::string(changed)});
    describe(database, layer, changed);
  }
}

void write_layers(const std::filesystem::path& map, std::span<const ShapeLayer> layers, MapAccess file) {
  const OpenMap open = open_for_update(map);
  if (file == MapAccess::exclusive)
    open.database.execute("PRAGMA cache_spill = ON; PRAGMA cache_size = -65536");
  sqlite::Transaction all(open.database);
  write_layers(open.database, layers, time_stamp_now());
  all.commit();
}

}  // namespace waymark::geodb
