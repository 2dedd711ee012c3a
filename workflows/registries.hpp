// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
namespace waymark::pipeline {
class Registry;
}

namespace waymark::workflows {

/// Registers the built-in stages in a registry that may hold others, too.
void register_built_in_stages(pipeline::Registry& registry);

/// Returns the stages: the built-in ones, and those of plug-ins that load_plug_in() has loaded.
const pipeline::Registry& all_stages();
/// Returns the landmark types likewise.
const TypeRegistry& all_types();
/// Returns the built-in sensor profiles.
const SensorRegistry& all_sensors();

}  // namespace waymark::workflows
