// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/console.hpp"
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
                      "as well by chance"}},
        .examples = {{"waymark register rough.gpkg --to craters.csv --crs IAU_2015:49910 -o site.gpkg",
                      "Place a map of Mars by a catalogue in degrees"},
                     {"waymark register rough.gpkg --dem made/dem.tif --to orbital.tif -o site.gpkg",
                      "Place a map from pictures by an orbital DEM"}}};
  }

  int run(const Session& session) override {
    request_.command_line = session.command_line;
    workflows::register_map(request_, console_callbacks(session));
    return 0;
  }

 private:
  workflows::RegisterRequest request_;
};

}  // namespace

void register_command_register(CommandTable& commands);
void register_command_register(CommandTable& commands) {
  commands.add<Register>();
}

}  // namespace waymark::apps
