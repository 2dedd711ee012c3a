// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/json_text.hpp"
#include "geodb/checks/map_checks.hpp"
#include "geodb/sqlite/sql_text.hpp"
#include "landmarks/colour.hpp"

namespace waymark::geodb {
namespace {

bool is_sha256(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void check_runs(const sqlite::Database& database, FindingList& findings) {
  if (database.integer("SELECT count(*) FROM run") == 0)
    findings.add("run.missing", "run", std::nullopt, "the map has no provenance: table run is empty");
  sqlite::Statement row = database.prepare("SELECT id, job, inputs, report FROM run");
  while (row.step()) {
    for (const int column : {1, 2, 3})
      if (find_json_fault(row.text(column)))
        findings.add("run.json", "run", row.integer(0),
                     fmt::format("column {} is not JSON", column == 1   ? "job"
                                                          : column == 2 ? "inputs"
                                                                        : "report"));
    const auto inputs =
        nlohmann::json::parse(json_or_empty(row.text(2)), nullptr, /*allow_exceptions=*/false);
    for (const auto& input : inputs)
      if (!input.is_object() || !input.contains("sha256") || !input["sha256"].is_string() ||
          !is_sha256(input["sha256"].get_ref<const std::string&>()))
        findings.add("run.hash", "run", row.integer(0), "an input file has no SHA-256");
  }
}

void check_types(const sqlite::Database& database, FindingList& findings) {
  sqlite::Statement row =
      database.prepare("SELECT id, name, colour, label_feature, size_feature FROM waymark_type");
  while (row.step()) {
    if (!is_colour(row.text(2)))
      findings.add("type.colour", "waymark_type", row.integer(0),
                   fmt::format("the colour of {} is not #rrggbb", row.text(1)));
    for (const int style : {3, 4}) {
      if (row.text(style).empty()) continue;
      sqlite::Statement feature =
          database.prepare("SELECT 1 FROM waymark_feature WHERE type = ? AND name = ?");
      const std::string type(row.text(1)), name(row.text(style));
      feature.bind_all(std::string_view(type), std::string_view(name));
      if (!feature.step())
        findings.add("type.style", "waymark_type", row.integer(0),
                     fmt::format("{} is drawn by a feature that it does not have", type));
    }
  }
}

}  // namespace

void check_layer(const sqlite::Database& database, const std::string& table, FindingList& findings) {
  const auto missing = [&](std::string_view where) {
    sqlite::Statement row = database.prepare(fmt::format("SELECT 1 FROM {} = ?", where));
    row.bind(1, table);
    return !row.step();
  };
  if (missing("gpkg_contents WHERE table_name"))
    findings.add("layer.unregistered", table, std::nullopt, "the table is not in gpkg_contents");
  if (missing("gpkg_geometry_columns WHERE table_name"))
    findings.add("layer.unregistered", table, std::nullopt, "the table is not in gpkg_geometry_columns");
  if (missing("layer_styles WHERE useAsDefault AND f_table_name"))
    findings.add("style.missing", table, std::nullopt, "the layer has no default style");
}

void find_rows(const sqlite::Database& database, FindingList& findings, const std::string& code,
               const std::string& table, const std::string& sql) {
  sqlite::Statement row = database.prepare(sql);
  while (row.step())
    findings.add(code, table, row.null(0) ? std::nullopt : std::optional(row.integer(0)),
                 std::string(row.text(1)));
}

void check_file(const sqlite::Database& database, const TypeRegistry& types, FindingList& findings) {
  sqlite::Statement integrity = database.prepare("PRAGMA quick_check");
  while (integrity.step())
    if (integrity.text(0) != "ok")
      findings.add("file.damaged", "", std::nullopt, std::string(integrity.text(0)));
  find_rows(database, findings, "file.foreign_key", "",
            "SELECT rowid, 'in table ' || \"table\" || ' refers to a missing row of ' || parent FROM "
            "pragma_foreign_key_check");
  if (!database.has_table("landmark") && types.size() > 0)
    findings.add("view.missing", "landmark", std::nullopt, "the view over all types is missing");
  sqlite::Statement view = database.prepare(sql_text("recursive_views"));
  while (view.step())
    findings.add("view.recursive", std::string(view.text(0)), std::nullopt,
                 "the view is recursive: its rows need not end");
  for (const auto& type : types) check_layer(database, type.name, findings);
  check_types(database, findings);
  check_runs(database, findings);
}

bool check_columns(const sqlite::Database& database, const LandmarkLayout& layout, FindingList& findings) {
  const std::string& table = layout.type().name;
  if (!database.has_table(table)) {
    findings.add("table.missing", table, std::nullopt, "the map declares this type but has no table for it");
    return false;
  }
  bool all = true;
  for (const auto& column : layout.columns()) {
    sqlite::Statement known = database.prepare("SELECT 1 FROM pragma_table_info(?) WHERE name = ?");
    known.bind_all(table, column.name);
    if (known.step()) continue;
    findings.add("column.missing", table, std::nullopt, "column '" + column.name + "' is missing");
    all = false;
  }
  return all;
}

}  // namespace waymark::geodb
