// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/planning/hazards.hpp"

namespace waymark::apps {
namespace {

std::vector<std::string> vehicle_names() {
  std::vector<std::string> names;
  for (const planning::VehicleFile& file : planning::vehicle_files()) names.emplace_back(file.name);
  return names;
}

class Hazards final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "hazards",
        .group = Group::use,
        .summary = "Map where a vehicle can stand: slope, roughness, steps, rocks, unknown terrain",
        .about =
            "A cell is judged with the vehicle's middle on it. Relief is that of a plane fitted under the "
            "vehicle's base. Rocks, crater walls and stems are those of the map, with their covariance and "
            "confidence; a DEM alone shows none. Rocks that the map cannot show are estimated from the "
            "sizes of the others. Terrain without heights is unknown, never safe.\n\n"
            "HAZARD.tif is a cloud-optimized GeoTIFF: slope, roughness and step with their standard "
            "deviations, object, undetected, probability and class (0 safe, 1 uncertain, 2 hazard, 3 "
            "unknown). A QGIS style is written beside it. The result does not depend on --threads or "
            "--tile-cells.",
        .arguments =
            {file_word("MAP|DEM", &request_.input, "Map (.gpkg), or an elevation model in metres"),
             Argument{"-o,--output", "HAZARD.tif", &request_.output, "Hazard map"}.needed().offering(
                 Offer::file),
             Argument{"--vehicle", "NAME|FILE", &request_.vehicle,
                      "Vehicle, or its file; `waymark vehicles` lists them"}
                 .offering(vehicle_names())
                 .or_else("rover"),
             Argument{"--dem", "DEM", &request_.dem, "Elevation model of a map; may be repeated"}
                 .offering(Offer::file)
                 .or_else("that stored in the map"),
             Argument{"--height-sd", "METRES", &request_.height_sd, "Standard deviation of a height"}.or_else(
                 "that of the DEM"),
             Argument{"--height-correlation", "METRES", &request_.height_correlation,
                      "Distance at which the correlation of two heights' errors has fallen to 1/e"}
                 .or_else("0"),
             Argument{"--rock-cover", "K", &request_.rock_cover,
                      "Fraction of the terrain that rocks cover, for those the map cannot show"}
                 .or_else("fitted to the map's rocks"),
             Argument{"--detection-limit", "METRES", &request_.detection_limit,
                      "Diameter from which the map has all rocks"}
                 .or_else("fitted to the map's rocks"),
             Argument{"--uncertain", "P", &request_.min_uncertain,
                      "Probability from which a cell is uncertain"}
                 .or_else("0.05"),
             Argument{"--hazard", "P", &request_.min_hazard, "Probability from which a cell is a hazard"}
                 .or_else("0.5"),
             Argument{
                 "--landing-ellipse", "MAJOR,MINOR[,AZIMUTH]", &request_.landing_ellipse,
                 "Add the band landing: the probability of a safe touchdown for an aim at each cell, with "
                 "these standard deviations (metres; degrees clockwise from north)"},
             Argument{"--sun", "AZIMUTH,ELEVATION", &request_.sun,
                      "Add the bands horizon (degrees, in the azimuth of the sun) and shade (1 where the "
                      "terrain hides the sun)"},
             Argument{"--horizon-reach", "METRES", &request_.horizon_reach,
                      "Farthest terrain that hides the sun"}
                 .or_else("1000"),
             Argument{"--aoi", "POLYGONS", &request_.aoi, "Terrain outside this area is unknown"}.offering(
                 Offer::file),
             Argument{"--crs", "CRS", &request_.crs, "CRS of a DEM whose file has none"},
             Argument{"--polygons", "FILE.gpkg", &request_.polygons,
                      "Write areas that are not safe as polygons, layer hazard"}
                 .offering(Offer::file),
             Argument{"--nav2", "MAP.yaml", &request_.nav2,
                      "Write a map for Nav2's map_server with hazards as obstacles, a PGM beside it"}
                 .offering(Offer::file),
             Argument{"--tile-cells", "N", &request_.tile_cells, "Cells per side of a tile"}.or_else("512"),
             format_option(&format_)},
        .examples =
            {{"waymark hazards site.gpkg --dem dem.tif -o hazard.tif", "For a rover, with the map's rocks"},
             {"waymark hazards site.gpkg --dem dem.tif -o land.tif --vehicle lander --polygons land.gpkg",
              "For a lander, with polygons"},
             {"waymark hazards dem.tif -o hazard.tif --vehicle robot.json --height-sd 0.05 --nav2 map.yaml",
              "A robot of your own, for Nav2"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.threads = static_cast<int>(session.threads);
    request_.command_line = session.command_line;
    const workflows::HazardMapResult made =
        workflows::make_hazard_map(request_, console_callbacks(session, format_));
    if (format_ == "json") print_made(made);
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {
        {"hazard_map", ResultKind::text, "Hazard map that was written"},
        {"polygons", ResultKind::text, "File of the polygons; null without --polygons"},
        {"nav2", ResultKind::text, "Map for Nav2; null without --nav2"},
        {"cells", ResultKind::counts, "Cells by class: safe, uncertain, hazard, unknown"},
        {"objects", ResultKind::integer, "Landmarks that may be hazards"},
        {"detected_diameter_m", ResultKind::number, "Diameter from which the map has all rocks"},
        {"rock_cover", ResultKind::number, "Fraction of the terrain under rocks, 0 to 1; null: not known"},
        {"rock_cover_sd", ResultKind::number, "Its standard deviation; null as rock_cover"},
        {"undetected_per_km", ResultKind::number,
         "Expected hazardous undetected rocks per kilometre driven; null as rock_cover"},
        {"undetected_per_km_sd", ResultKind::number, "Its standard deviation; null as rock_cover"}};
  }

  void print_made(const workflows::HazardMapResult& made) const {
    const planning::UndetectedRocks& rocks = made.undetected;
    const auto if_known = [&](double value) { return rocks.known ? ResultValue(value) : ResultValue(); };
    const std::vector<std::string> classes = workflows::hazard_class_names();
    std::map<std::string, std::int64_t> cells;
    for (std::size_t i = 0; i < classes.size(); ++i) cells[classes[i]] = made.cells.at(i);
    print_result(result_keys(), {{"hazard_map", request_.output},
                                 {"polygons", text_or_null(request_.polygons)},
                                 {"nav2", text_or_null(request_.nav2)},
                                 {"cells", cells},
                                 {"objects", made.objects},
                                 {"detected_diameter_m", rocks.detected_diameter},
                                 {"rock_cover", if_known(rocks.cover.k)},
                                 {"rock_cover_sd", if_known(rocks.cover.sd)},
                                 {"undetected_per_km", if_known(1000 * made.undetected_per_metre.value)},
                                 {"undetected_per_km_sd", if_known(1000 * made.undetected_per_metre.sd)}});
  }

  std::string format_ = "text";
  workflows::HazardMapRequest request_;
};

}  // namespace

void register_command_hazards(CommandTable& commands);
void register_command_hazards(CommandTable& commands) {
  commands.add<Hazards>();
}

}  // namespace waymark::apps
