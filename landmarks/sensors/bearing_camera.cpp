// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

void register_sensor_bearing_camera(SensorRegistry& sensors);
void register_sensor_bearing_camera(SensorRegistry& sensors) {
  sensors.add({.name = "bearing_camera",
               .summary = "Camera that measures bearings: prefers summits by prominence and isolation",
               .weights = {{"mountain_top", "prominence", 1},
                           {"mountain_top", "isolation", 1},
                           {"mountain_top", "elevation", 0.5},
                           {"rock", "height", 1},
                           {"tree", "height", 1}},
               .coverage = {.range = 100, .bearing_sd = 0.3}});
}

}  // namespace waymark::inline landmarks
