// SPDX-License-Identifier: Apache-2.0
// Apart from the stages, so that programs without the pipeline can use them.
#include "workflows/registries.hpp"

namespace waymark::workflows {

const TypeRegistry& all_types() {
  static const TypeRegistry registry = [] {
    TypeRegistry made;
    register_landmark_types(made);
    return made;
  }();
  return registry;
}

const SensorRegistry& all_sensors() {
  static const SensorRegistry registry = [] {
    SensorRegistry made;
    register_sensor_profiles(made);
    return made;
  }();
  return registry;
}

}  // namespace waymark::workflows
