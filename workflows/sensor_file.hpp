// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include "landmarks/sensor_profile.hpp"
namespace waymark::workflows {

/// Reads a sensor file (docs/reference/sensor.md). `source` names the file in messages. Throws Error{usage}
/// for unknown keys, types and features, numbers out of range, and weights of a type that do not sum to 1.
SensorProfile parse_sensor(std::string_view json, const std::string& name, const std::string& source);

/// Returns a profile as a sensor file: the weights of each type are divided by their sum.
std::string sensor_as_json(const SensorProfile& sensor);

/// Returns a built-in sensor profile by name, or reads the file (.json) of that path. Throws Error{usage}
/// with the nearest name if there is none.
std::shared_ptr<const SensorProfile> find_sensor(const std::string& name_or_file);

/// Returns the same, and for the name "map" the profile of the latest run of the map file that records one.
/// Throws Error{usage} if none does.
std::shared_ptr<const SensorProfile> find_sensor(const std::string& name_or_file, const std::string& map);

/// Adds a profile to the job of a run under "sensor". An empty job becomes an object.
void record_sensor(std::string& job_json, const SensorProfile& sensor);

}  // namespace waymark::workflows
