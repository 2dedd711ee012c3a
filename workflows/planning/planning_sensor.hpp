// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "landmarks/sensor_profile.hpp"
#include "localization/line_of_sight.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/localization/robot_map.hpp"
namespace waymark::workflows {

/// Returns the coverage of a sensor with another range (metres) and field of view (degrees) where these are
/// above 0. Throws Error{usage} if it has no range; `name` is what the user called it.
SensorCoverage planning_coverage(const SensorProfile& sensor, const std::string& name, double range,
                                 double view);

/// Returns a line of sight on `dem`, or on the terrain of the map if that is empty; empty without terrain.
/// Thread-safe. The heights of `area` (map frame, metres) are held in memory (sight_terrain.hpp). The body's
/// curvature counts, on Earth less by a refraction of 0.13.
localization::LineOfSight planning_line_of_sight(const RobotMap& map, const std::vector<std::string>& dem,
                                                 const localization::LineOfSightOptions& options,
                                                 const Eigen::AlignedBox2d& area,
                                                 const Callbacks& callbacks = {});

}  // namespace waymark::workflows
