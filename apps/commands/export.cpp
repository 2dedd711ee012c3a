// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "core/error.hpp"
#include "exporters/vector/export_map.hpp"
#include "geodb/postgres/connection.hpp"
#include "geodb/postgres/postgres_map.hpp"
#include "workflows/localization/export_robot_map.hpp"
#include "workflows/query/area_of_map.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class Export final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "export",
        .group = Group::use,
        .summary = "Write the landmarks of a map in another format",
        .about =
            "Any vector format GDAL writes. Formats that hold one layer get one file per landmark type.\n\n"
            "Crater counts for craterstats: .scc has the craters with their positions and the outline of "
            "the counting area, .diam their diameters. The area is that of the images' footprints, or of "
            "the DEM.\n\n"
            "For robots: -of beluga writes the landmarks with a category for each type, -of MRPT the beacons "
            "of a "
            "landmark map in a configuration, both in metres of the frame of `waymark localize`.\n\n"
            "pg:CONNECTION stores the whole map, with evidence and runs, in a schema of a PostgreSQL "
            "database "
            "(schema=NAME, default waymark). A schema that holds a map is updated by uid.",
        .arguments = {file_word("MAP.gpkg", &map_, "Map to read"),
                      file_word("OUT", &out_,
                                "File to write; its extension selects the format. Or pg:CONNECTION"),
                      Argument{"-of,--format", "OGR_DRIVER", &options_.driver,
                               "Format by GDAL's name, if the extension is ambiguous"}
                          .offering({"GPKG", "GeoJSON", "KML", "CSV", "FlatGeobuf", "beluga", "MRPT"}),
                      Argument{"--type", "T", &options_.types, "Landmarks of this type only; may be repeated"}
                          .offering(workflows::all_types().names()),
                      Argument{"--aoi", "POLYGONS", &aoi_,
                               "Landmarks inside this area only; a .gpkg is then a map of the area"}
                          .offering(Offer::file),
                      {"--min-confidence", "P", &options_.min_confidence,
                       "Landmarks that exist with at least this probability, 0 to 1"},
                      Argument{"--crs", "CRS", &options_.crs, "CRS of the output"}.or_else("the map's"),
                      Argument{"--area", "KM2", &options_.area_km2,
                               "Counting area of a crater count (.scc, .diam)"}
                          .or_else("the map's footprints, or its DEM"),
                      {"--label", "NAME=VALUE", &options_.label,
                       "Value of a PDS4 label, LOGICAL_IDENTIFIER for example; may be repeated"},
                      Argument{"--memory", "MEGABYTES", &options_.max_megabytes,
                               "Memory for the spatial index of FlatGeobuf, 220 bytes a landmark; one that "
                               "would take more is left out"}
                          .or_else(std::to_string(exporters::ExportOptions{}.max_megabytes)),
                      {"--overwrite", "", &options_.overwrite, "Replace an existing output"},
                      Argument{"--summary", "FORMAT", &summary_,
                               "Form of standard output, since --format is that of the file"}
                          .one_of({"text", "json"})
                          .or_else("text")},
        .examples =
            {{"waymark export alps.gpkg alps.geojson", "For the web: longitude and latitude"},
             {"waymark export alps.gpkg alps.csv --crs EPSG:32632 --type mountain_top",
              "A table in UTM metres"},
             {"waymark export mars.gpkg mars.fgb -of FlatGeobuf", "A format by name"},
             {"waymark export forest.gpkg parcel.gpkg --aoi parcel.geojson", "A map of a part of the area"},
             {"waymark export alps.gpkg alps.sqlite", "SQLite, with geometries and indexes of SpatiaLite"},
             {"waymark export mars.gpkg mars.xml -of PDS4 --label LOGICAL_IDENTIFIER=urn:nasa:pds:b:c:p",
              "A table with a label for the Planetary Data System"},
             {"waymark export craters.gpkg craters.scc", "A crater count for craterstats"},
             {"waymark export forest.gpkg trees.yaml -of beluga --type tree", "A landmark list for a robot"},
             {"waymark export alps.gpkg 'pg:dbname=maps schema=alps'", "To PostGIS"}},
        .result = result_keys(),
        .result_option = "--summary"};
  }

  int run(const Session&) override {
    if (!(options_.min_confidence >= 0 && options_.min_confidence <= 1))
      throw Error(ErrorCode::usage, fmt::format("--min-confidence is {:g}", options_.min_confidence), "",
                  "it is a probability: 0 to 1");
    if (geodb::postgres::is_address(out_)) return export_to_server();
    if (const auto format = workflows::parse_robot_format(options_.driver)) return export_to_robot(*format);
    if (!aoi_.empty()) options_.inside = workflows::area_of_map(aoi_, map_).contains;
    const exporters::ExportSummary done = exporters::export_map(map_, out_, options_);
    for (const std::string& warning : done.warnings) log_warning(warning);
    std::int64_t landmarks = 0;
    std::map<std::string, std::int64_t> by_type;
    for (const exporters::ExportedLayer& layer : done.layers) {
      if (!prints_json()) log_summary(fmt::format("{} {}\n", layer.landmarks, layer.type));
      by_type[layer.type] += layer.landmarks;
      landmarks += layer.landmarks;
    }
    if (landmarks == 0 && !aoi_.empty())
      log_warning("no landmark lies in the area of interest, " + aoi_ + ": check its CRS");
    if (prints_json())
      print(done.files, done.driver, done.crs, landmarks, by_type);
    else
      log_summary(fmt::format("{}: {}, {}\n", fmt::join(done.files, ", "), done.driver, done.crs));
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"files", ResultKind::texts, "Files that were written; none for a database"},
            {"driver", ResultKind::text, "Format: GDAL's name, beluga, MRPT, or PostgreSQL"},
            {"crs", ResultKind::text, "CRS of the output; null for a robot's list and a database"},
            {"landmarks", ResultKind::integer, "Landmarks that were written"},
            {"by_type", ResultKind::counts, "The same by type; null for a robot's list and a database"}};
  }

  bool prints_json() const { return summary_ == "json"; }
  static void print(const std::vector<std::string>& files, const std::string& driver, const std::string& crs,
                    std::int64_t landmarks, const std::map<std::string, std::int64_t>& by_type) {
    print_result(result_keys(), {{"files", files},
                                 {"driver", driver},
                                 {"crs", text_or_null(crs)},
                                 {"landmarks", landmarks},
                                 {"by_type", crs.empty() ? ResultValue() : ResultValue(by_type)}});
  }

  int export_to_robot(workflows::RobotFormat format) {
    if (!options_.crs.empty())
      throw Error(ErrorCode::usage,
                  "a robot's landmark list is in metres of the local frame: --crs does not apply", out_,
                  "leave it out");
    refuse_others("a robot's landmark list");
    const workflows::ExportedRobotMap done =
        workflows::export_robot_map({.map = map_,
                                     .output = out_,
                                     .format = format,
                                     .types = options_.types,
                                     .min_confidence = options_.min_confidence,
                                     .overwrite = options_.overwrite});
    for (const std::string& warning : done.warnings) log_warning(warning);
    if (prints_json())
      print({out_}, options_.driver, {}, done.landmarks, {});
    else
      log_summary(fmt::format("{}: {} landmarks, {}\n", out_, done.landmarks, options_.driver));
    return 0;
  }

  int export_to_server() {
    if (!options_.types.empty() || !options_.crs.empty() || !options_.driver.empty())
      throw Error(ErrorCode::usage,
                  "a database stores the whole map: --type, --crs and --format do not apply", out_,
                  "leave them out");
    if (options_.min_confidence > 0)
      throw Error(ErrorCode::usage, "--min-confidence does not apply to a database", out_,
                  "export the likely landmarks to a .gpkg first, and that map then");
    refuse_others("a database");
    const geodb::PostgresSummary done = geodb::export_to_postgres(map_, out_);
    if (prints_json())
      print({}, "PostgreSQL", {}, done.landmarks, {});
    else
      log_summary(
          fmt::format("{} landmarks {}\n", done.landmarks, done.created ? "stored" : "added or updated"));
    if (!done.has_postgis)
      log_warning("the database has no PostGIS: geometries are stored as bytes (CREATE EXTENSION postgis)");
    return 0;
  }

  /// Throws for options that these outputs do not have.
  void refuse_others(const std::string& output) const {
    if (!aoi_.empty())
      throw Error(ErrorCode::usage, "--aoi does not apply to " + output, out_,
                  "export the area to a .gpkg first, and that map then");
    if (!options_.label.empty() || options_.area_km2 != 0)
      throw Error(ErrorCode::usage, "--label and --area do not apply to " + output, out_, "leave them out");
  }

  std::string map_, out_, aoi_, summary_ = "text";
  exporters::ExportOptions options_;
};

}  // namespace

void register_command_export(CommandTable& commands);
void register_command_export(CommandTable& commands) {
  commands.add<Export>();
}

}  // namespace waymark::apps
