// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
#include "pipeline/engine/registry.hpp"
namespace waymark {

/// Everything this program was built with.
const Registry& all_stages();
const TypeRegistry& all_types();
const SensorRegistry& all_sensors();

}  // namespace waymark
