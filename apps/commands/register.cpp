// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "core/units.hpp"
#include "workflows/mapping/register_map.hpp"

namespace waymark::apps {
namespace {

class Register final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "register",
        .group = Group::make,
        .summary = "Place a map in the coordinates of a crater catalogue or a DEM",
        .about =
            "Finds shift, turn and scale of a map in rough or arbitrary coordinates, without a start: by "
            "distances and ratios of diameters of its craters, or by its heights in a DEM, which give the "
            "vertical shift, too. Landmarks, observations, images and layers move with it; lengths are "
            "scaled. The covariance of the registration is added to that of the landmarks. By craters, "
            "heights are scaled about their mean.\n\n"
            "Too few craters, flat or simple relief and ambiguous places are refused, exit code 1.",
        .arguments =
            {file_word("MAP.gpkg", &request_.map, "Map with craters, in metres"),
             Argument{"--to", "CATALOGUE|DEM", &request_.catalogue,
                      "Table or layer of craters, positions and radii or diameters; or a DEM"}
                 .needed()
                 .offering(Offer::file),
             Argument{"-o,--output", "MAP2.gpkg", &request_.result, "Map to write"}.needed().offering(
                 Offer::file),
             Argument{"--dem", "FILE", &request_.dem,
                      "Heights of the map in its own coordinates, to compare with a DEM"}
                 .or_else("the map's elevation tiles")
                 .offering(Offer::file),
             Argument{"--columns", "TARGET=EXPRESSION,...", &request_.columns,
                      "What the columns of the catalogue are, as for `waymark import`"}
                 .or_else("by their names"),
             Argument{"--crs", "CRS", &request_.crs, "CRS of the new map, projected"}.or_else(
                 "the map's, or that of catalogue or DEM if the map's is local"),
             Argument{"--max-scale", "FACTOR", &request_.rules.max_scale,
                      "Largest factor by which the scale of the map may be wrong"},
             Argument{"--within", "M", &request_.rules.max_shift, "Largest shift of the map's middle"}
                 .or_else("any"),
             Argument{"--max-wrong", "P", &request_.rules.max_wrong,
                      "Largest probability of a wrong place that is accepted; with a DEM, number of places "
                      "that fit "
                      "as well by chance"},
             format_option(&format_)},
        .examples = {{"waymark register rough.gpkg --to craters.csv --crs IAU_2015:49910 -o site.gpkg",
                      "Place a map of Mars by a catalogue in degrees"},
                     {"waymark register rough.gpkg --dem made/dem.tif --to orbital.tif -o site.gpkg",
                      "Place a map from pictures by an orbital DEM"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.command_line = session.command_line;
    const workflows::MapPlace place = workflows::register_map(request_, console_callbacks(session, format_));
    if (format_ == "json") print_place(place);
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"map", ResultKind::text, "Map that was written"},
            {"crs", ResultKind::text, "Its CRS"},
            {"scale", ResultKind::number, "Length in the new map per length in the old one"},
            {"scale_sd", ResultKind::number, "Standard deviation of the scale"},
            {"yaw_deg", ResultKind::number, "Turn of the map, from x towards y"},
            {"yaw_sd_deg", ResultKind::number, "Its standard deviation"},
            {"middle_m", ResultKind::object, "x, y and z of the map's middle in the new CRS, metres"},
            {"middle_sd_m", ResultKind::object, "Their standard deviations"},
            {"compared", ResultKind::integer, "Craters, or cells of heights"},
            {"agreed", ResultKind::integer, "Those of them that match"},
            {"residual_m", ResultKind::number,
             "Root mean square of their differences: positions of craters, or heights"}};
  }

  void print_place(const workflows::MapPlace& place) const {
    const workflows::MapMove& move = place.move;
    const double scale = std::exp(move.plane.log_scale);
    const auto sd = [&](int k) { return std::sqrt(move.covariance(k, k)); };
    const auto degrees = [](double radians) { return to_degrees(Radians{radians}).value; };
    print_result(result_keys(), {{"map", request_.result},
                                 {"crs", place.crs.id()},
                                 {"scale", scale},
                                 {"scale_sd", scale * sd(3)},
                                 {"yaw_deg", degrees(move.plane.yaw)},
                                 {"yaw_sd_deg", degrees(sd(2))},
                                 {"middle_m", xyz(move.pivot.x(), move.pivot.y(), move.pivot.z())},
                                 {"middle_sd_m", xyz(sd(0), sd(1), sd(4))},
                                 {"compared", place.compared},
                                 {"agreed", place.agreed},
                                 {"residual_m", place.residual}});
  }

  static ResultJson xyz(double x, double y, double z) {
    return {nlohmann::ordered_json{{"x", x}, {"y", y}, {"z", z}}.dump()};
  }

  std::string format_ = "text";
  workflows::RegisterRequest request_;
};

}  // namespace

void register_command_register(CommandTable& commands);
void register_command_register(CommandTable& commands) {
  commands.add<Register>();
}

}  // namespace waymark::apps
