// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

void register_sensor_stereo_camera(SensorRegistry& sensors);
void register_sensor_stereo_camera(SensorRegistry& sensors) {
  sensors.add({.name = "stereo_camera",
               .summary = "Pair of cameras: measures width and height at close range",
               .weights = {{"rock", "radius", 1},
                           {"rock", "height", 1},
                           {"tree", "diameter", 1},
                           {"tree", "height", 0.3},
                           {"crater", "radius", 0.5},
                           {"crater", "depth", 0.5}},
               .coverage = {.range = 15, .view = 70, .range_sd = 0.1, .bearing_sd = 0.6}});
}

}  // namespace waymark::inline landmarks
