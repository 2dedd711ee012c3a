// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/planning_sensor.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <memory>
#include <utility>

#include "core/error.hpp"

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
                                                 const localization::LineOfSightOptions& options) {
  const auto open = [&map, dem, options] {
    return localization::terrain_line_of_sight(open_terrain(map, dem), options);
  };
  localization::LineOfSight here = open();
  if (!here) return {};
  const auto of_thread = std::make_shared<tbb::enumerable_thread_specific<localization::LineOfSight>>(open);
  of_thread->local() = std::move(here);
  return [of_thread](const localization::Pose2& sensor, const Eigen::Vector2d& landmark) {
    return of_thread->local()(sensor, landmark);
  };
}

}  // namespace waymark::workflows
