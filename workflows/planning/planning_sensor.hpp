// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "landmarks/sensor_profile.hpp"
namespace waymark::workflows {

/// Returns the coverage of a sensor with another range (metres) and field of view (degrees) where these are
/// above 0. Throws Error{usage} if it has no range; `name` is what the user called it.
SensorCoverage planning_coverage(const SensorProfile& sensor, const std::string& name, double range,
                                 double view);

}  // namespace waymark::workflows
