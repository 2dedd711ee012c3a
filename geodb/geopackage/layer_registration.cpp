// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/layer_registration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <vector>

#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

constexpr std::string_view kRelatedTables = "http://www.geopackage.org/18-000.html";

// The schema extension requires finite limits of a range.
double representable(double limit) {
  constexpr double huge = std::numeric_limits<double>::max();
  return std::isfinite(limit) ? limit : std::copysign(huge, limit);
}

}  // namespace

void register_layer(const sqlite::Database& database, const Layer& layer) {
  sqlite::Statement contents = database.prepare(
      "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change, srs_id,"
      "  min_x, min_y, max_x, max_y) VALUES (?1, 'features', ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)");
  const Envelope& box = layer.extent;
  contents.bind_all(layer.table, layer.description, layer.changed, std::int64_t{layer.srs_id});
  if (!box.empty()) {
    int parameter = 4;
    for (const double side : {box.min_x, box.min_y, box.max_x, box.max_y}) contents.bind(++parameter, side);
  }
  contents.run();
  sqlite::Statement geometry =
      database.prepare("INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, ?, 0)");
  geometry.bind_all(layer.table, layer.geometry_type, std::int64_t{layer.srs_id}, int{layer.z});
  geometry.run();
}

void create_spatial_index(const sqlite::Database& database, std::string_view table) {
  database.execute(substitute_keys(sql_text("rtree"), {{"t", table}}));
}

void register_images(const sqlite::Database& database, const Envelope& extent, std::int32_t srs_id,
                     std::string_view changed) {
  register_layer(database, {.table = "image",
                            .description = "Images, with the ground they show",
                            .geometry_type = "MULTIPOLYGON",
                            .extent = extent,
                            .srs_id = srs_id,
                            .changed = std::string(changed)});
}

std::int32_t srs_id_of_map(const sqlite::Database& database) {
  return static_cast<std::int32_t>(database.integer(
      "SELECT srs_id FROM gpkg_geometry_columns ORDER BY table_name NOT IN ('image', 'landmark') LIMIT 1"));
}

void create_edit_triggers(const sqlite::Database& database, std::string_view table) {
  database.execute(substitute_keys(sql_text("edits"), {{"t", table}}));
}

void describe_columns(const sqlite::Database& database, const LandmarkLayout& layout) {
  const LandmarkType& type = layout.type();
  sqlite::Statement constraint =
      database.prepare("INSERT INTO gpkg_data_column_constraints VALUES (?, 'range', NULL, ?, 1, ?, 1, ?)");
  const auto range_name = [&](std::string_view column) {
    return fmt::format("{}_{}_range", type.name, column);
  };
  for (const auto& f : type.features) {
    const std::string name = range_name(f.name);
    constraint.bind_all(name, representable(f.min_value), representable(f.max_value), "plausible values");
    constraint.run();
  }
  sqlite::Statement column =
      database.prepare("INSERT INTO gpkg_data_columns VALUES (?, ?, ?, ?, ?, NULL, ?)");
  for (const auto& c : layout.columns()) {
    const bool feature = std::ranges::find(type.features, c.name, &FeatureSpec::name) != type.features.end();
    const std::optional<std::string> range = feature ? std::optional(range_name(c.name)) : std::nullopt;
    column.bind_all(type.name, c.name, c.name, c.title, c.description, range);
    column.run();
  }
}

void create_evidence_links(const sqlite::Database& database, const std::string& type) {
  const std::string mapping = type + "_observation";
  database.execute(substitute_keys(
      R"(CREATE TABLE "{m}" (base_id INTEGER NOT NULL, related_id INTEGER NOT NULL);
         CREATE INDEX "{m}_base" ON "{m}" (base_id);)",
      {{"m", mapping}}));
  sqlite::Statement relation = database.prepare(
      "INSERT INTO gpkgext_relations (base_table_name, related_table_name, relation_name, mapping_table_name)"
      "  VALUES (?, 'observation', 'attributes', ?)");
  relation.bind_all(type, mapping);
  relation.run();
  sqlite::Statement extension = database.prepare(
      "INSERT OR IGNORE INTO gpkg_extensions VALUES (?, NULL, 'gpkg_related_tables', ?, 'read-write')");
  for (const std::string_view table : {std::string_view("gpkgext_relations"), std::string_view(mapping)}) {
    if (table != mapping && database.integer("SELECT count(*) FROM gpkgext_relations") > 1) continue;
    extension.bind_all(table, kRelatedTables);
    extension.run();
  }
}

void store_style(const sqlite::Database& database, std::string_view table, const std::string& qml,
                 const std::string& sld, std::string_view summary, std::string_view changed) {
  sqlite::Statement style = database.prepare(
      "INSERT INTO layer_styles (f_table_name, f_geometry_column, styleName, styleQML, styleSLD, "
      "useAsDefault, description, update_time) VALUES (?1, 'geom', ?1, ?2, ?3, 1, ?4, ?5)");
  style.bind_all(table, qml, sld, summary, changed);
  style.run();
}

void create_landmark_view(const sqlite::Database& database, const TypeRegistry& types) {
  std::vector<std::string> parts;
  for (const auto& type : types)
    parts.push_back(substitute_keys(
        R"(SELECT t.id AS id, k.name AS type, t.geom AS geom, t.uid AS uid, t.quality AS quality, t.seen AS seen,
  t.visible AS visible, t.q_multiplicity AS q_multiplicity, t.confidence AS confidence, t.var_x AS var_x,
  t.var_y AS var_y, t.cov_xy AS cov_xy, t.var_z AS var_z, t.observations AS observations
  FROM "{t}" t, waymark_type k WHERE k.name = '{t}')",
        {{"t", type.name}}));
  database.execute(fmt::format("CREATE VIEW landmark AS\n{}", fmt::join(parts, "\nUNION ALL\n")));
}

}  // namespace waymark::geodb
