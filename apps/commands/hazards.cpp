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
                      "Write the probability for Nav2's map_server, with a PGM beside it"}
                 .offering(Offer::file),
             Argument{"--tile-cells", "N", &request_.tile_cells, "Cells per side of a tile"}.or_else("512")},
        .examples = {
            {"waymark hazards site.gpkg --dem dem.tif -o hazard.tif", "For a rover, with the map's rocks"},
            {"waymark hazards site.gpkg --dem dem.tif -o land.tif --vehicle lander --polygons land.gpkg",
             "For a lander, with polygons"},
            {"waymark hazards dem.tif -o hazard.tif --vehicle robot.json --height-sd 0.05 --nav2 map.yaml",
             "A robot of your own, for Nav2"}}};
  }

  int run(const Session& session) override {
    request_.threads = static_cast<int>(session.threads);
    request_.command_line = session.command_line;
    workflows::make_hazard_map(request_, console_callbacks(session));
    return 0;
  }

 private:
  workflows::HazardMapRequest request_;
};

}  // namespace

void register_command_hazards(CommandTable& commands);
void register_command_hazards(CommandTable& commands) {
  commands.add<Hazards>();
}

}  // namespace waymark::apps
