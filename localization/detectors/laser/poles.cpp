// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/laser_stems.hpp"

namespace waymark::localization {

void register_laser_poles(DetectorTable& detectors);
void register_laser_poles(DetectorTable& detectors) {
  detectors.add({.name = "poles",
                 .summary = "Posts from 4 to 30 cm wide, free on both sides",
                 .record = "laser",
                 .types = {"pole"},
                 .finds_single_objects = true,
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   LaserStemOptions options = post_options();
                   options.type = type_in_map(types, "pole");
                   if (options.type)
                     options.diameter_feature = feature_index(types[*options.type], "diameter");
                   return [options](const LaserScan& scan) { return sightings_of_stems(scan, options); };
                 }});
}

}  // namespace waymark::localization
