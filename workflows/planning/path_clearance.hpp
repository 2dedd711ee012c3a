// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "workflows/localization/robot_map.hpp"
#include "workflows/planning/route.hpp"
namespace waymark::workflows {

/// Adds bounds of clearance and tilt to the stations of all routes, if the request has a DEM. The pose may be
/// off by two planned standard deviations, heights by two of the DEM. Returns lines for the summary; empty
/// without a DEM. Throws Error{input} for a DEM of over 25 million cells.
std::string add_clearance(const RouteRequest& request, const RobotMap& map, RouteResult& result);

}  // namespace waymark::workflows
