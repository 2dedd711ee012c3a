// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "planning/clearance.hpp"
#include "planning/hazard_map.hpp"
#include "planning/route_search.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Request of a route over a map. Positions are in the map's CRS.
struct RouteRequest {
  std::string map, output;
  std::string from, to;           ///< "X,Y" or "X,Y,YAW" (degrees from the CRS's x axis to its y axis)
  std::vector<std::string> via;   ///< "X,Y", in order
  std::string hazards = "none";   ///< hazard map (.tif), or none
  std::string aoi = {};           ///< polygons: the route stays inside; empty: anywhere
  std::string sensor;             ///< name or file (.json) of a sensor profile
  double range = 0, view = 0;     ///< metres, degrees; 0: those of the sensor
  double limit_sigma = 0;         ///< metres; 0: none
  double keep_landmarks = 0;      ///< number; 0: not wanted
  double weight = 0;              ///< metres of detour per metre at an sd of 1 m
  bool min_sigma = false;         ///< the smallest worst sd
  bool by_quality = false;        ///< keep_landmarks sums qualities
  double cell = 2;                ///< metres
  double start_sd = 0;            ///< metres; 0: that of the odometry's log, else 0.1
  std::string odometry;           ///< log of the vehicle, whose odometry noise is used; empty: the defaults
  double speed = 0.5;             ///< m/s, turns biases of rates into errors per metre
  bool identities_known = false;  ///< false: sightings can be taken for other landmarks
  std::int64_t worlds = 32;       ///< random sets of existing landmarks
  std::int64_t alternatives = 1;
  std::int64_t seed = 1;
  std::vector<std::string> dem = {};  ///< terrain that hides landmarks, for clearance and tilt at the
                                      ///< stations; empty: that stored in the map hides, no clearance
  double sensor_height = 1;           ///< metres above the terrain
  std::string vehicle = "rover";      ///< of clearance and tilt
};

/// One row of the layer `route_station`.
struct RouteStation {
  Eigen::Vector2d at;            ///< map CRS
  double distance = 0, yaw = 0;  ///< metres; radians from the first axis of the map's CRS (in degrees: east)
  planning::Symmetric3 covariance;  ///< along the axes of the map's CRS, metres and radians
  double sd = 0;
  int landmarks = 0;
  std::vector<std::string> important;                       ///< uids of the three that inform most
  std::optional<planning::ClearanceBounds> clearance = {};  ///< with a DEM, where the terrain is known
};

struct PlannedRoute {
  double length = 0, worst_sd = 0, final_sd = 0, without_landmarks = 0, outside = 0;
  double worlds_mean = 0, worlds_worst_tenth = 0;  ///< worst sd over worlds, metres
  std::vector<RouteStation> stations;
};

struct RouteResult {
  std::vector<PlannedRoute> routes;
  PlannedRoute shortest;   ///< for comparison
  double lower_bound = 0;  ///< metres, of the length of any route on these cells that keeps the limit
};

/// Plans a route and writes it. Throws Error{input} for a start or goal in a hazard, on unknown terrain or
/// outside, and if there is no route. If no route keeps the limit, the message has the smallest one that was
/// reached.
RouteResult plan_route(const RouteRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
