// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "landmarks/sensor_profile.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Logs with true poses, and the map of the site, from which a sensor profile is fitted.
struct SensorFitRequest {
  std::vector<std::string> logs;
  std::string map;
  std::string output = {};  ///< sensor file (.json) to write; empty: none
};

/// Fits range, view, noise and detection of a sensor (localization/sensor_fit.hpp) and gives equal weights to
/// the features that it measured. Uses landmarks of confidence 0.5 or more. Throws Error{usage} without logs
/// or map, Error{input} for logs without true poses. Messages: one summary.
SensorProfile train_sensor(const SensorFitRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
