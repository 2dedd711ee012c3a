// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/planning_sensor.hpp"

#include <fmt/format.h>

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

}  // namespace waymark::workflows
