// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
#include "workflows/localization/robot_map.hpp"
namespace waymark::workflows {

/// Station of a planned route.
struct RoutePoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< map frame, metres
  double sd = 0;                                 ///< metres, planned, of the position; 0: not planned
};

/// Reads the first route of a file that `waymark route` wrote (.csv, .gpkg, .geojson), or any table with the
/// columns x and y in the map's CRS. Throws Error{input} for fewer than two stations, and for jumps of over
/// 50 km, as where a route crosses the antimeridian.
std::vector<RoutePoint> read_route(const std::string& file, const RobotMap& map);

}  // namespace waymark::workflows
