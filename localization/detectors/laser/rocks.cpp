// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/laser_rocks.hpp"

namespace waymark::localization {

void register_laser_rocks(DetectorTable& detectors);
void register_laser_rocks(DetectorTable& detectors) {
  detectors.add({.name = "rocks",
                 .summary = "Rocks, by a scanner close above the ground",
                 .record = "laser",
                 .types = {"rock"},
                 .finds_single_objects = true,
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   return [rock = type_in_map(types, "rock")](const LaserScan& scan) {
                     return sightings_of_rocks(scan, {.type = rock});
                   };
                 }});
}

}  // namespace waymark::localization
