// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/import_landmarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <span>

#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/printable.hpp"
#include "geodb/write_map.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/rules/ready_rules.hpp"
#include "importers/rules/rule_landmarks.hpp"
#include "importers/tables/import_mapping.hpp"
#include "importers/tables/table.hpp"
#include "workflows/mapping/staged_landmarks.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

constexpr std::size_t kLandmarksInMemory = 10'000;  // 1 to 2 kB each

/// Returns the request with what its mapping file states and itself does not.
ImportRequest with_mapping(ImportRequest request) {
  if (request.mapping.empty()) return request;
  const importers::ImportMapping stated = importers::read_import_mapping(request.mapping);
  const auto fill = [](std::string& own, const std::string& from_file) {
    if (own.empty()) own = from_file;
  };
  importers::TableImport& own = request.options;
  fill(request.layer, stated.layer);
  fill(own.table_crs, stated.table.table_crs);
  fill(own.map_crs, stated.table.map_crs);
  fill(own.columns, stated.table.columns);
  fill(own.type, stated.table.type);
  own.type_column = stated.table.type_column;
  own.type_words = stated.table.type_words;
  own.columns_of_type = stated.table.columns_of_type;
  return request;
}

importers::ImportedTable read_table(const ImportRequest& request, StagedLandmarks& landmarks) {
  const importers::TableFormat format = request.format == "csv"   ? importers::TableFormat::csv
                                        : request.format == "ogr" ? importers::TableFormat::ogr
                                                                  : importers::TableFormat::by_name;
  if (!request.unit.empty())
    throw Error(ErrorCode::usage, "--unit is for rules, not for tables", "--unit",
                "--columns converts: x=geom_x/1000,y=geom_y/1000");
  const auto source = importers::open_table(request.table, format, request.layer, request.options.type);
  return importers::import_table(*source, all_types(), request.options,
                                 [&](Landmark&& landmark) { landmarks.add(std::move(landmark)); });
}

importers::ImportedTable read_elements(const ImportRequest& request, StagedLandmarks& landmarks) {
  for (const auto& [given, name] : {std::pair{!request.mapping.empty(), "--mapping"},
                                    {!request.options.columns.empty(), "--columns"},
                                    {!request.options.type.empty(), "--type"}})
    if (given)
      throw Error(ErrorCode::usage, fmt::format("{} is for tables, not for rules", name), "--rules",
                  "rules give the types and their features");
  importers::ImportRules rules = importers::read_import_rules(request.rules);
  if (!request.unit.empty()) rules.unit = request.unit;
  const auto first = [](const std::string& a, const std::string& b) { return a.empty() ? b : a; };
  const std::string table_crs = first(request.options.table_crs, rules.crs),
                    map_crs = first(request.options.map_crs, rules.map_crs);
  const bool local = first(table_crs, map_crs) == "local";
  const auto source = importers::open_elements(request.table, first(request.layer, rules.layer), local);
  return importers::import_by_rules(
      *source, request.table, all_types(), rules, table_crs, map_crs,
      [&](Landmark&& landmark) { landmarks.add(std::move(landmark)); }, request.options.aoi);
}

/// Reads Landmark_Groundtruth.dat: numbered posts in a local CRS.
importers::ImportedTable read_mrclam_table(const std::string& file, const std::string& type,
                                           StagedLandmarks& landmarks) {
  importers::ImportedTable table;
  for (Landmark& landmark :
       importers::import_mrclam_landmarks(file, all_types().id(type), *all_types().find(type))) {
    landmarks.add(std::move(landmark));
    ++table.landmarks;
  }
  table.rows = table.landmarks;
  table.types = {type};
  table.bindings = {"uid: subject", "x", "y", "covariance: deviations of x and y"};
  return table;
}

geodb::RunRecord run_record(const importers::ImportedTable& table, const std::string& file,
                            const std::string& command_line, std::chrono::system_clock::time_point started) {
  pipeline::StageReport stage;
  stage.stage = "import_table";
  stage.units = stage.made = 1;
  stage.counts.in = table.rows;
  stage.counts.out = table.landmarks;
  for (const auto& [reason, count] : table.rejected_by_reason) stage.counts.rejected[reason] = count;
  stage.warnings = table.warnings;
  return make_single_step_record(std::move(stage), file, command_line, started);
}

/// Returns what fits on a screen: a table may have any number of columns, with names of any length.
std::string shown_columns(std::span<const std::string> columns) {
  constexpr std::size_t kMaxColumns = 20, kMaxNameBytes = 60;
  const std::size_t shown = std::min(columns.size(), kMaxColumns);
  std::string text;
  for (const std::string& column : columns.first(shown))
    text += (text.empty() ? "" : ", ") + printable(column, kMaxNameBytes);
  if (columns.size() > shown) text += fmt::format(" and {} more", columns.size() - shown);
  return text;
}

void send_counts(const importers::ImportedTable& table, bool by_rules, const Callbacks& callbacks) {
  callbacks.summary(fmt::format("{}\n", fmt::join(table.bindings, by_rules ? "\n" : ", ")));
  if (!table.unused.empty()) callbacks.summary(fmt::format("not used: {}\n", shown_columns(table.unused)));
  for (const std::string& warning : table.warnings) callbacks.warning(warning);
  callbacks.summary(fmt::format("{} rows, {} landmarks, {} rejected\n", table.rows, table.landmarks,
                                table.rows - table.landmarks));
  for (const auto& [reason, count] : table.rejected_by_reason)
    callbacks.summary(fmt::format("    {} {}\n", count, reason));
  if (!table.first_rejection.empty())
    callbacks.summary(fmt::format("    the first: {}\n", table.first_rejection));
}

}  // namespace

std::vector<std::string> ready_rule_names() {
  std::vector<std::string> names;
  for (const auto& [name, rules] : importers::ready_rules()) names.push_back(name);
  return names;
}

std::string rules_text(const std::string& file_or_name) {
  if (file_or_name.empty())
    throw Error(ErrorCode::usage, "--print-rules needs --rules", "--rules",
                fmt::format("ready ones are {}", fmt::join(ready_rule_names(), ", ")));
  return importers::import_rules_text(file_or_name);
}

importers::ImportedTable import_landmarks(const ImportRequest& request, const Callbacks& callbacks) {
  check_map_output(request.map);
  keep_inputs(request.map, {request.table, request.mapping, request.rules, request.options.aoi});
  const auto started = std::chrono::system_clock::now();
  std::string file = request.table;
  const std::filesystem::path folder = std::filesystem::path(request.map).parent_path();
  StagedLandmarks landmarks(all_types(), folder.empty() ? "." : folder);
  importers::ImportedTable table;
  if (request.format == "mrclam") {
    if (!request.options.aoi.empty())
      throw Error(ErrorCode::usage, "--aoi does not apply to the few posts of an MRCLAM dataset", "--aoi",
                  "`waymark export MAP PART.gpkg --aoi AREA` takes a part of the map");
    if (std::filesystem::is_directory(file))
      file = (std::filesystem::path(file) / "Landmark_Groundtruth.dat").string();
    const std::string coded = all_types()[find_self_identifying_type(all_types()).value()].name;
    table = read_mrclam_table(file, request.options.type.empty() ? coded : request.options.type, landmarks);
  } else if (!request.rules.empty()) {
    table = read_elements(request, landmarks);
  } else {
    table = read_table(with_mapping(request), landmarks);
  }
  geodb::MapContents contents;
  contents.types = all_types();
  contents.crs = table.crs;
  contents.run = run_record(table, file, request.command_line, started);
  send_counts(table, !request.rules.empty(), callbacks);
  contents.parts = landmarks.finish(table.crs, file);
  contents.observations = std::move(table.rejected);
  geodb::write_map(request.map, contents,
                   {.empty_tables = table.types, .max_landmarks_in_memory = kLandmarksInMemory});
  callbacks.summary(fmt::format("{}: {} landmarks in {}\n", request.map, table.landmarks, contents.crs.id()));
  return table;
}

}  // namespace waymark::workflows
