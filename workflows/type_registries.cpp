// SPDX-License-Identifier: Apache-2.0
// Apart from the stages, so that programs without the pipeline can use them.
#include "workflows/open_registries.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {

TypeRegistry& open_types() {
  static TypeRegistry registry = [] {
    TypeRegistry made;
    register_landmark_types(made);
    return made;
  }();
  return registry;
}

const TypeRegistry& all_types() {
  return open_types();
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
