// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

void register_sensor_harvester_laser(SensorRegistry& sensors);
void register_sensor_harvester_laser(SensorRegistry& sensors) {
  sensors.add(
      {.name = "harvester_laser",
       .summary = "Horizontal laser scanner of a forest machine: measures stem diameters",
       .weights = {{"tree", "diameter", 1}},
       .coverage = {.range = 30, .view = 270, .range_sd = 0.05, .bearing_sd = 0.5, .detection = 0.7}});
}

}  // namespace waymark::inline landmarks
