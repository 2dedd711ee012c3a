// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/import_landmarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>

#include "core/error.hpp"
#include "geodb/write_map.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/tables/table.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

importers::ImportedTable read_table(const ImportRequest& request) {
  const importers::TableFormat format = request.format == "csv"   ? importers::TableFormat::csv
                                        : request.format == "ogr" ? importers::TableFormat::ogr
                                                                  : importers::TableFormat::by_name;
  const auto source = importers::open_table(request.table, format, request.layer, request.options.type);
  return importers::import_table(*source, all_types(), request.options);
}

/// Reads Landmark_Groundtruth.dat: numbered posts in a local CRS.
importers::ImportedTable read_mrclam_table(const std::string& file, const std::string& type) {
  importers::ImportedTable table;
  table.landmarks = importers::import_mrclam_landmarks(file, all_types().id(type), *all_types().find(type));
  table.rows = static_cast<std::int64_t>(table.landmarks.size());
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
  stage.counts.out = static_cast<std::int64_t>(table.landmarks.size());
  for (const auto& [reason, count] : table.rejected_by_reason) stage.counts.rejected[reason] = count;
  stage.warnings = table.warnings;
  return make_single_step_record(std::move(stage), file, command_line, started);
}

void send_counts(const importers::ImportedTable& table, const Callbacks& callbacks) {
  callbacks.summary(fmt::format("{}\n", fmt::join(table.bindings, ", ")));
  for (const std::string& warning : table.warnings) callbacks.warning(warning);
  const auto kept = static_cast<std::int64_t>(table.landmarks.size());
  callbacks.summary(fmt::format("{} rows, {} landmarks, {} rejected\n", table.rows, kept, table.rows - kept));
  for (const auto& [reason, count] : table.rejected_by_reason)
    callbacks.summary(fmt::format("    {} {}\n", count, reason));
  if (!table.first_rejection.empty())
    callbacks.summary(fmt::format("    the first: {}\n", table.first_rejection));
}

}  // namespace

importers::ImportedTable import_landmarks(const ImportRequest& request, const Callbacks& callbacks) {
  check_map_output(request.map);
  const auto started = std::chrono::system_clock::now();
  std::string file = request.table;
  importers::ImportedTable table;
  if (request.format == "mrclam") {
    if (std::filesystem::is_directory(file))
      file = (std::filesystem::path(file) / "Landmark_Groundtruth.dat").string();
    table = read_mrclam_table(file, request.options.type.empty() ? "beacon" : request.options.type);
  } else {
    table = read_table(request);
  }
  geodb::MapContents contents;
  contents.types = all_types();
  contents.crs = table.crs;
  contents.run = run_record(table, file, request.command_line, started);
  send_counts(table, callbacks);
  contents.landmarks = std::move(table.landmarks);
  contents.observations = std::move(table.rejected);
  geodb::write_map(request.map, contents, {.empty_tables = table.types});
  callbacks.summary(
      fmt::format("{}: {} landmarks in {}\n", request.map, contents.landmarks.size(), contents.crs.id()));
  return table;
}

}  // namespace waymark::workflows
