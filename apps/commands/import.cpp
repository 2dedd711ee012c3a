// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "core/error.hpp"
#include "geodb/map_store.hpp"
#include "geodb/postgres/connection.hpp"
#include "geodb/postgres/postgres_map.hpp"
#include "workflows/mapping/import_landmarks.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class Import final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "import",
        .group = Group::make,
        .summary = "Make a map of points from other tools and catalogues",
        .about =
            "Text tables (separated by comma, semicolon, tab, bar or blanks) and every vector layer GDAL "
            "reads. Columns with the name of a feature are used for it, in metres unless their name says "
            "otherwise (depth_km, \"Depth (km)\"); a diameter gives the radius. The interpretation of the "
            "columns is printed, and those not used.\n\n"
            "--columns overrides it: target=expression, separated by commas. Targets are x, y, z, uid, "
            "the features and attributes of the type, confidence, seen, visible, observations, and "
            "deviations: position_sd, x_sd, y_sd, z_sd in metres, <feature>_sd. Expressions may use the "
            "table's columns (those with blanks in double quotes), geom_x, geom_y, geom_z and geom_area "
            "of geometries, numbers, + - * / ^, parentheses, pi, sqrt, abs, exp, log, log10, sin, cos, "
            "tan, deg, rad, min and max. \"depth=\" leaves a target out.\n\n"
            "Rows without a position and rows outside the plausible range of a feature (`waymark types`) "
            "are rejected and counted.\n\n"
            "--rules makes landmarks of the elements of GIS layers, drawings and city models by their tags "
            "and geometries: points, centroids, corners, ends, walls.\n\n"
            "pg:CONNECTION reads a map that `waymark export` stored in PostgreSQL (schema=NAME, default "
            "waymark).",
        .arguments =
            {file_word("TABLE", &request_.table, "Table to read; /vsi paths too. Or pg:CONNECTION"),
             Argument{"-o,--output", "MAP.gpkg", &request_.map,
                      "Map to write; an older map of that name is replaced"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--type", "T", &request_.options.type, "Landmark type of the rows"}
                 .offering(workflows::all_types().names())
                 .or_else("the table's column `type`, or the layer's name"),
             Argument{"--from", "FORMAT", &request_.format, "Kind of table"}
                 .one_of({"csv", "ogr", "mrclam"})
                 .or_else("csv for .csv, .tsv, .txt, .dat, .tab; else ogr"),
             Argument{"--map-crs", "CRS", &request_.options.map_crs, "CRS of the map"}.or_else("the table's"),
             Argument{"--crs", "CRS", &request_.options.table_crs,
                      "CRS of the table's positions, in place of what the table says"}
                 .or_else("the table's own, or --map-crs"),
             Argument{"--columns", "TARGET=EXPRESSION,...", &request_.options.columns, "What the columns are"}
                 .or_else("by their names"),
             Argument{"--mapping", "FILE.json", &request_.mapping,
                      "Mapping file: types by the words of a column, columns, CRSs; options win"}
                 .offering(Offer::file),
             Argument{"--rules", "FILE.json|NAME", &request_.rules,
                      "Rules for GIS layers: tags to types; a file, or " + names_of_ready_rules()}
                 .offering(Offer::file),
             Argument{"--print-rules", "", &print_rules_, "Print these rules and stop"}.alone(),
             Argument{"--layer", "NAME", &request_.layer, "Layer of a file that holds several"},
             Argument{"--unit", "UNIT", &request_.unit,
                      "Unit of local coordinates, with --rules: m, dm, cm, mm, km, in, ft, yd, mi, us_ft"}
                 .or_else("that a DXF file states, else metres"),
             Argument{"--aoi", "POLYGONS", &request_.options.aoi,
                      "Area of interest, in any CRS of the body: rows outside are rejected"}
                 .offering(Offer::file),
             {"--skip-bad-rows", "", &request_.options.skip_bad_rows,
              "Reject rows that cannot be read, instead of stopping at the first"},
             format_option(&format_)},
        .examples =
            {{"waymark import LROCCraters.csv -o moon.gpkg --type crater --map-crs IAU_2015:30100 --columns "
              "'x=Long,y=Lat,radius=\"Diameter (km)\"*500'",
              "A catalogue of the Moon"},
             {"waymark import stems.shp -o trees.gpkg --type tree --columns "
              "'diameter=dbh_cm/100,position_sd=0.3'",
              "A survey with its accuracy"},
             {"waymark import truth.csv -o truth.gpkg --map-crs EPSG:32611",
              "All types of a table with a column `type`"},
             {"waymark import town.osm -o town.gpkg --rules osm",
              "Lamps, signs, trees and buildings of OpenStreetMap"},
             {"waymark import plan.dxf -o hall.gpkg --rules floor_plan --map-crs local --unit mm",
              "Walls and doors of a drawing in millimetres"},
             {"waymark import 'pg:dbname=maps schema=alps' -o alps.gpkg", "A map from PostGIS"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    if (print_rules_) {
      std::cout << workflows::rules_text(request_.rules);
      return 0;
    }
    if (geodb::postgres::is_address(request_.table)) {
      if (!request_.options.aoi.empty())
        throw Error(ErrorCode::usage, "--aoi does not apply to a map in a database", "--aoi",
                    "import the map, then `waymark export MAP.gpkg PART.gpkg --aoi AREA`");
      geodb::import_from_postgres(request_.table, request_.map);
      if (format_ == "json") print_stored();
      return 0;
    }
    request_.command_line = session.command_line;
    const importers::ImportedTable table =
        workflows::import_landmarks(request_, console_callbacks(session, format_));
    if (format_ == "json") print_table(table);
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"map", ResultKind::text, "Map that was written"},
            {"crs", ResultKind::text, "Its CRS"},
            {"types", ResultKind::texts, "Landmark types that were read"},
            {"landmarks", ResultKind::integer, "Landmarks of the map"},
            {"rows", ResultKind::integer, "Rows of the table; null for a map from PostgreSQL"},
            {"rejected", ResultKind::counts, "Rejected rows by reason"},
            {"first_rejection", ResultKind::text, "Where and why the first was rejected; null: none was"},
            {"columns", ResultKind::texts, "How the columns were interpreted"},
            {"unused_columns", ResultKind::texts, "Columns of the table that were not used"},
            {"warnings", ResultKind::texts, "Warnings, which standard error has, too"}};
  }

  void print_table(const importers::ImportedTable& table) const {
    print_result(result_keys(), {{"map", request_.map},
                                 {"crs", table.crs.id()},
                                 {"types", table.types},
                                 {"landmarks", table.landmarks},
                                 {"rows", table.rows},
                                 {"rejected", table.rejected_by_reason},
                                 {"first_rejection", text_or_null(table.first_rejection)},
                                 {"columns", table.bindings},
                                 {"unused_columns", table.unused},
                                 {"warnings", table.warnings}});
  }

  void print_stored() const {
    const geodb::MapStore map = geodb::MapStore::open(request_.map);
    print_result(result_keys(), {{"map", request_.map},
                                 {"crs", map.crs().id()},
                                 {"types", map.types().names()},
                                 {"landmarks", map.count()},
                                 {"rows", {}},
                                 {"rejected", std::map<std::string, std::int64_t>()},
                                 {"first_rejection", {}},
                                 {"columns", std::vector<std::string>()},
                                 {"unused_columns", std::vector<std::string>()},
                                 {"warnings", std::vector<std::string>()}});
  }

  static std::string names_of_ready_rules() {
    std::string names;
    for (const std::string& name : workflows::ready_rule_names()) names += (names.empty() ? "" : ", ") + name;
    return names;
  }

  workflows::ImportRequest request_;
  bool print_rules_ = false;
  std::string format_ = "text";
};

}  // namespace

void register_command_import(CommandTable& commands);
void register_command_import(CommandTable& commands) {
  commands.add<Import>();
}

}  // namespace waymark::apps
