// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/laser_stems.hpp"

namespace waymark::localization {

void register_laser_pillars(DetectorTable& detectors);
void register_laser_pillars(DetectorTable& detectors) {
  detectors.add({.name = "pillars",
                 .summary = "Round columns from 0.3 to 2 m wide, free on both sides",
                 .record = "laser",
                 .types = {"pillar"},
                 .finds_single_objects = true,
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   LaserStemOptions options = pillar_options();
                   options.type = type_in_map(types, "pillar");
                   if (options.type)
                     options.diameter_feature = feature_index(types[*options.type], "diameter");
                   return [options](const LaserScan& scan) { return sightings_of_stems(scan, options); };
                 }});
}

}  // namespace waymark::localization
