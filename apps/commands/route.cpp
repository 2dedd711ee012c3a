// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/route.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class RouteCommand final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "route",
        .group = Group::use,
        .summary = "Plan a route that keeps good landmarks in sight",
        .about =
            "The covariance of the position is propagated along the route with the odometry noise of "
            "`waymark localize` and the landmarks that the sensor sees. Give one objective: --limit-sigma "
            "keeps the sd below a limit on the shortest route, --keep-landmarks drives the least length "
            "with fewer landmarks in sight, --weight is a compromise of length and sd, --least-sigma has the "
            "smallest worst sd.\n\n"
            "OUT.gpkg has the layers route and route_station: the ellipse of the error, the landmarks in "
            "sight, and the three that inform most.",
        .arguments =
            {file_word("MAP.gpkg", &request_.map, "Map of landmarks"),
             Argument{"--from", "X,Y[,YAW]", &request_.from,
                      "Start in the map's CRS; yaw in degrees from its x axis, in a CRS in degrees from east"}
                 .needed(),
             Argument{"--to", "X,Y", &request_.to, "Goal in the map's CRS"}.needed(),
             Argument{"--via", "X,Y", &request_.via, "Position to pass; may be repeated, in order"},
             Argument{"-o,--output", "OUT", &request_.output, "OUT.gpkg, OUT.geojson or OUT.csv"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--hazards", "FILE|none", &request_.hazards,
                      "Hazard map that `waymark hazards` made, or none"}
                 .offering(Offer::file)
                 .or_else("none"),
             Argument{"--aoi", "POLYGONS", &request_.aoi, "Stay inside this area"}.offering(Offer::file),
             Argument{"--sensor", "NAME|FILE", &request_.sensor,
                      "Sensor with its coverage; `waymark sensors` lists them, FILE.json is one of "
                      "your own, map: the profile that the map records"}
                 .needed()
                 .offering(workflows::all_sensors().names()),
             Argument{"--range", "METRES", &request_.range, "Range of the sensor"}.or_else(
                 "that of the profile"),
             Argument{"--view", "DEGREES", &request_.view, "Horizontal field of view"}.or_else(
                 "that of the profile"),
             Argument{"--limit-sigma", "METRES", &request_.limit_sigma,
                      "Largest sd of the position on the route"},
             Argument{"--keep-landmarks", "N", &request_.keep_landmarks, "Landmarks to keep in sight"},
             Argument{"--by-quality", "", &request_.by_quality,
                      "Sum their qualities in place of counting them"},
             Argument{"--weight", "W", &request_.weight, "Metres of detour per metre driven at an sd of 1 m"},
             Argument{"--least-sigma", "", &request_.min_sigma,
                      "Drive where the largest sd is the smallest that is found"},
             Argument{"--odometry", "LOG", &request_.odometry,
                      "Log of the vehicle: its header states the odometry noise and the errors at the start"}
                 .offering(Offer::file)
                 .or_else("noise of an unknown vehicle"),
             Argument{"--speed", "M/S", &request_.speed, "Speed of the drive, for biases of turn rates"}
                 .or_else("0.5"),
             Argument{"--cell", "METRES", &request_.cell, "Cells of the search"}.or_else("2"),
             Argument{"--start-sd", "METRES", &request_.start_sd, "Sd of the position at the start"}.or_else(
                 "that of the log, else 0.1"),
             Argument{"--ids", "HOW", &ids_,
                      "Whether the robot knows which landmark it sees; unknown: one that others resemble in "
                      "position counts less"}
                 .one_of({"known", "unknown"})
                 .or_else("unknown"),
             Argument{"--worlds", "N", &request_.worlds,
                      "Random sets of existing landmarks that check the route"}
                 .or_else("32"),
             Argument{"--alternatives", "N", &request_.alternatives,
                      "Routes along the front of length and sd, each a tenth better"}
                 .or_else("1"),
             Argument{"--dem", "DEM...", &request_.dem,
                      "Terrain: hides landmarks, and gives the stations bounds of the belly's clearance and "
                      "of the tilt; that stored in the map hides, too"}
                 .offering(Offer::file),
             Argument{"--sensor-height", "METRES", &request_.sensor_height,
                      "Height of the sensor above the terrain"}
                 .or_else("1"),
             Argument{"--vehicle", "NAME|FILE", &request_.vehicle, "Vehicle of these bounds"}.or_else(
                 "rover"),
             Argument{"--seed", "N", &request_.seed, "Seed of the worlds"}.or_else("1"),
             format_option(&format_)},
        .examples =
            {{"waymark route site.gpkg --from 0,0 --to 300,120 --sensor horizontal_laser --limit-sigma 0.5 "
              "--hazards hazard.tif -o route.gpkg",
              "The shortest route with an sd of at most half a metre"},
             {"waymark route site.gpkg --from 0,0 --to 300,120 --sensor stereo_camera --keep-landmarks 3 -o "
              "route.csv",
              "Three landmarks in sight wherever possible"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.identities_known = ids_ == "known";
    const workflows::RouteResult planned =
        workflows::plan_route(request_, console_callbacks(session, format_));
    if (format_ == "json") print_routes(planned);
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {
        {"route", ResultKind::text, "File of the routes that was written"},
        {"routes", ResultKind::objects,
         "Planned routes, the best first: length_m, worst_sd_m and goal_sd_m of the position, "
         "without_landmarks_m (length without a landmark in sight), outside_m (length with fewer landmarks "
         "than --keep-landmarks), worlds_worst_sd_m and worlds_worst_tenth_sd_m (the worst sd over random "
         "sets of existing landmarks: on average, in the worst tenth), stations"},
        {"shortest", ResultKind::object, "Shortest route, for comparison; keys as in routes"},
        {"lower_bound_m", ResultKind::number,
         "No route on these cells that keeps --limit-sigma is shorter; null without that limit"}};
  }

  static std::string route_json(const workflows::PlannedRoute& route) {
    return result_object({{"length_m", route.length},
                          {"worst_sd_m", route.worst_sd},
                          {"goal_sd_m", route.final_sd},
                          {"without_landmarks_m", route.without_landmarks},
                          {"outside_m", route.outside},
                          {"worlds_worst_sd_m", route.worlds_mean},
                          {"worlds_worst_tenth_sd_m", route.worlds_worst_tenth},
                          {"stations", std::int64_t(route.stations.size())}});
  }

  void print_routes(const workflows::RouteResult& planned) const {
    std::vector<std::string> routes;
    for (const workflows::PlannedRoute& route : planned.routes) routes.push_back(route_json(route));
    print_result(
        result_keys(),
        {{"route", request_.output},
         {"routes", ResultJson{"[" + fmt::format("{}", fmt::join(routes, ",")) + "]"}},
         {"shortest", ResultJson{route_json(planned.shortest)}},
         {"lower_bound_m", request_.limit_sigma > 0 ? ResultValue(planned.lower_bound) : ResultValue()}});
  }

  std::string format_ = "text", ids_ = "unknown";
  workflows::RouteRequest request_;
};

}  // namespace

void register_command_route(CommandTable& commands);
void register_command_route(CommandTable& commands) {
  commands.add<RouteCommand>();
}

}  // namespace waymark::apps
