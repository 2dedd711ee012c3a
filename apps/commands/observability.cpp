// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/observability.hpp"
#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class ObservabilityCommand final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "observability",
        .group = Group::use,
        .summary = "Map how well a sensor can be localized by the landmarks in sight",
        .about =
            "INFO.tif is a cloud-optimized GeoTIFF over all terrain from which a landmark can be seen: "
            "position_sd and yaw_sd are what remains after a straight drive of --drive metres from a known "
            "pose, if all the time the landmarks of that cell are in sight, for the least favourable of "
            "eight headings; then the landmarks in sight, the sum of their qualities, and the information "
            "per metre driven, means over the headings. A QGIS style is written beside it.\n\n"
            "Noise of the odometry and correlated errors of the map are those of `waymark route`. "
            "Identities are taken as known. With a DEM, terrain hides landmarks as it does for `waymark "
            "localize`, and the curvature of the body as well.",
        .arguments =
            {file_word("MAP.gpkg", &request_.map, "Map of landmarks, in metres"),
             Argument{"-o,--output", "INFO.tif", &request_.output, "Raster"}.needed().offering(Offer::file),
             Argument{"--sensor", "NAME|FILE", &request_.sensor,
                      "Sensor with its coverage; `waymark sensors` lists them, FILE.json is one of "
                      "your own, map: the profile that the map records"}
                 .needed()
                 .offering(workflows::all_sensors().names()),
             Argument{"--range", "METRES", &request_.range, "Range of the sensor"}.or_else(
                 "that of the profile"),
             Argument{"--view", "DEGREES", &request_.view, "Horizontal field of view"}.or_else(
                 "that of the profile"),
             Argument{"--cell", "METRES", &request_.cell, "Cells of the raster"}.or_else(
                 "2, or as wide as makes about a million cells"),
             Argument{"--dem", "DEM...", &request_.dem, "Terrain that hides landmarks"}
                 .offering(Offer::file)
                 .or_else("that stored in the map"),
             Argument{"--sensor-height", "METRES", &request_.sensor_height,
                      "Height of the sensor above the terrain"}
                 .or_else("1"),
             Argument{"--aoi", "POLYGONS", &request_.aoi, "Cover only this area; cells outside have no value"}
                 .offering(Offer::file),
             Argument{"--drive", "METRES", &request_.drive, "Length of the drive"}.or_else("100"),
             Argument{"--tile-cells", "N", &request_.tile_cells, "Cells per side of a tile"}.or_else("256"),
             format_option(&format_)},
        .examples = {{"waymark observability site.gpkg -o info.tif --sensor horizontal_laser",
                      "Where a rover can be localized"},
                     {"waymark observability stand.gpkg -o info.tif --sensor map --cell 5 --drive 500",
                      "For the sensor that the map records, over longer drives"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.threads = static_cast<int>(session.threads);
    const workflows::ObservabilityResult made =
        workflows::make_observability(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(),
                   {{"raster", request_.output},
                    {"columns", made.columns},
                    {"rows", made.rows},
                    {"cell_m", made.cell},
                    {"seen", made.seen},
                    {"median_sd_m", made.seen > 0 ? ResultValue(made.median_sd) : ResultValue()}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"raster", ResultKind::text, "Raster that was written"},
            {"columns", ResultKind::integer, "Its columns"},
            {"rows", ResultKind::integer, "Its rows"},
            {"cell_m", ResultKind::number, "Size of its cells, metres"},
            {"seen", ResultKind::number, "Fraction of the cells with a landmark in sight, 0 to 1"},
            {"median_sd_m", ResultKind::number,
             "Median of position_sd over these cells, to 5 %; null: no landmark is in sight"}};
  }

  std::string format_ = "text";
  workflows::ObservabilityRequest request_;
};

}  // namespace

void register_command_observability(CommandTable& commands);
void register_command_observability(CommandTable& commands) {
  commands.add<ObservabilityCommand>();
}

}  // namespace waymark::apps
