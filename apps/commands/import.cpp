// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "apps/output_path.hpp"
#include "apps/provenance.hpp"
#include "apps/registries.hpp"
#include "apps/session.hpp"
#include "core/error.hpp"
#include "geodb/write_map.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/tables/table_landmarks.hpp"

namespace waymark {
namespace {

using Clock = std::chrono::system_clock;

RunRecord record_of(const ImportedTable& table, const std::string& path, const Session& session,
                    Clock::time_point started) {
  StageReport stage;
  stage.stage = "import_table";
  stage.units = stage.made = 1;
  stage.counts.in = table.rows;
  stage.counts.out = static_cast<std::int64_t>(table.landmarks.size());
  for (const auto& [reason, count] : table.rejected_by_reason) stage.counts.rejected[reason] = count;
  stage.warnings = table.warnings;
  return record_of_one(std::move(stage), path, session, started);
}

class Import final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "import",
        .group = Group::make,
        .summary = "Make a map of points from other tools and catalogues",
        .about =
            "Text tables (separated by comma, semicolon, tab, bar or blanks) and every vector layer GDAL "
            "reads. "
            "Columns that bear the name of a feature are taken as it, in metres unless their name says "
            "otherwise (depth_km, \"Depth (km)\"); a diameter gives the radius. What was taken for what is "
            "told.\n\n"
            "--columns says it otherwise: target=expression, separated by commas. Targets are x, y, z, uid, "
            "the "
            "features and attributes of the type, confidence, seen, visible, observations, and deviations: "
            "position_sd, x_sd, y_sd, z_sd in metres, <feature>_sd. Expressions know the table's columns "
            "(those "
            "with blanks in double quotes), geom_x, geom_y, geom_z and geom_area of geometries, numbers, "
            "+ - * / ^, parentheses, pi, sqrt, abs, exp, log, log10, sin, cos, tan, deg, rad, min and max. "
            "\"depth=\" leaves a target out.\n\n"
            "Rows without a position and rows outside the plausible range of a feature (`waymark types`) are "
            "rejected and counted.",
        .arguments = {file_word("TABLE", &table_, "Table to read; /vsi paths too"),
                      Argument{"-o,--output", "MAP.gpkg", &map_,
                               "Map to write; an older map of that name is replaced"}
                          .needed()
                          .offering(Offer::file),
                      Argument{"--type", "T", &how_.type, "What the rows are"}
                          .offering(all_types().names())
                          .or_else("the table's column `type`, or the layer's name"),
                      Argument{"--from", "FORMAT", &from_, "Kind of table"}
                          .one_of({"csv", "ogr", "mrclam"})
                          .or_else("csv for .csv, .tsv, .txt, .dat, .tab; else ogr"),
                      Argument{"--map-crs", "CRS", &how_.map_crs, "CRS of the map"}.or_else("the table's"),
                      Argument{"--crs", "CRS", &how_.table_crs,
                               "CRS of the table's positions, in place of what the table says"}
                          .or_else("the table's own, or --map-crs"),
                      Argument{"--columns", "TARGET=EXPRESSION,...", &how_.columns, "What the columns are"}
                          .or_else("by their names"),
                      Argument{"--layer", "NAME", &layer_, "Layer of a file that holds several"},
                      {"--skip-bad-rows", "", &how_.skip_bad_rows,
                       "Reject rows that cannot be read, instead of stopping at the first"}},
        .examples = {
            {"waymark import LROCCraters.csv -o moon.gpkg --type crater --map-crs IAU_2015:30100 --columns "
             "'x=Long,y=Lat,radius=\"Diameter (km)\"*500'",
             "A catalogue of the Moon"},
            {"waymark import stems.shp -o trees.gpkg --type tree --columns "
             "'diameter=dbh_cm/100,position_sd=0.3'",
             "A survey with its accuracy"},
            {"waymark import truth.csv -o truth.gpkg --map-crs EPSG:32611",
             "All types of a table with a column `type`"}}};
  }

  int run(const Session& session) override {
    check_map_output(map_);
    const auto started = Clock::now();
    ImportedTable table = from_ == "mrclam" ? mrclam_table() : generic_table();
    MapContents contents;
    contents.types = all_types();
    contents.crs = table.crs;
    contents.run = record_of(table, table_, session, started);
    tell(table);
    contents.landmarks = std::move(table.landmarks);
    contents.observations = std::move(table.rejected);
    write_map(map_, contents, {.empty_tables = table.types});
    say(fmt::format("{}: {} landmarks in {}\n", map_, contents.landmarks.size(), contents.crs.id()));
    return 0;
  }

 private:
  ImportedTable generic_table() {
    const TableFormat format = from_ == "csv"   ? TableFormat::csv
                               : from_ == "ogr" ? TableFormat::ogr
                                                : TableFormat::by_name;
    const auto source = open_table(table_, format, layer_, how_.type);
    return import_table(*source, all_types(), how_);
  }

  /// Landmark_Groundtruth.dat: numbered posts in a local CRS.
  ImportedTable mrclam_table() {
    if (std::filesystem::is_directory(table_))
      table_ = (std::filesystem::path(table_) / "Landmark_Groundtruth.dat").string();
    const std::string type = how_.type.empty() ? "beacon" : how_.type;
    ImportedTable table;
    table.landmarks = import_mrclam_landmarks(table_, all_types().id(type), *all_types().find(type));
    table.rows = static_cast<std::int64_t>(table.landmarks.size());
    table.types = {type};
    table.bindings = {"uid: subject", "x", "y", "covariance: deviations of x and y"};
    return table;
  }

  void tell(const ImportedTable& table) const {
    say(fmt::format("{}\n", fmt::join(table.bindings, ", ")));
    for (const std::string& warning : table.warnings) log_warning(warning);
    const auto kept = static_cast<std::int64_t>(table.landmarks.size());
    say(fmt::format("{} rows, {} landmarks, {} rejected\n", table.rows, kept, table.rows - kept));
    for (const auto& [reason, count] : table.rejected_by_reason)
      say(fmt::format("    {} {}\n", count, reason));
    if (!table.first_rejection.empty()) say(fmt::format("    the first: {}\n", table.first_rejection));
  }

  std::string table_, map_, from_, layer_;
  TableImport how_;
};

}  // namespace

void register_command_import(CommandTable& commands);
void register_command_import(CommandTable& commands) {
  commands.add<Import>();
}

}  // namespace waymark
