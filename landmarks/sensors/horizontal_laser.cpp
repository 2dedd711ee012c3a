// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"
namespace waymark::inline landmarks {

void register_sensor_horizontal_laser(SensorRegistry& sensors);
void register_sensor_horizontal_laser(SensorRegistry& sensors) {
  sensors.add({.name = "horizontal_laser",
               .summary = "Horizontal line scanner: measures widths, not heights",
               .weights = {{"rock", "radius", 1},
                           {"rock", "height", 0.2},
                           {"tree", "diameter", 1},
                           {"crater", "radius", 0.2}},
               .coverage = {.range = 25, .view = 270, .range_sd = 0.1, .bearing_sd = 0.6}});
}

}  // namespace waymark::inline landmarks
