// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/planning_sensor.hpp"

#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "workflows/planning/sight_terrain.hpp"

namespace waymark::workflows {

SensorCoverage planning_coverage(const SensorProfile& sensor, const std::string& name, double range,
                                 double view) {
  SensorCoverage coverage = sensor.coverage;
  if (range > 0) coverage.range = range;
  if (view > 0) coverage.view = view;
  if (!(coverage.range > 0))
    throw Error(ErrorCode::usage, fmt::format("the sensor '{}' has no range", name), "",
                "pass --range METRES, or another sensor");
  return coverage;
}

localization::LineOfSight planning_line_of_sight(const RobotMap& map, const std::vector<std::string>& dem,
                                                 const localization::LineOfSightOptions& options,
                                                 const Eigen::AlignedBox2d& area,
                                                 const Callbacks& callbacks) {
  const std::shared_ptr<const DemSource> source = open_dem(map, dem);
  if (!source) return {};
  const Body& body = map.crs().body();
  return localization::terrain_line_of_sight(
      sight_terrain(*source, map.frame, area, {.progress = callbacks.progress}), options,
      body.name.empty() ? 0 : body.mean_radius(), body.name == "Earth" ? 0.13 : 0);
}

}  // namespace waymark::workflows
