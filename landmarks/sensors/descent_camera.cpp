// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

void register_sensor_descent_camera(SensorRegistry& sensors);
void register_sensor_descent_camera(SensorRegistry& sensors) {
  sensors.add({.name = "descent_camera",
               .summary = "Nadir camera of a lander: measures outlines, not heights",
               .weights = {{"crater", "radius", 1},
                           {"crater", "major_axis", 1},
                           {"crater", "minor_axis", 1},
                           {"crater", "orientation", 0.5},
                           {"rock", "radius", 1},
                           {"tree", "crown_diameter", 1}}});
}

}  // namespace waymark::inline landmarks
