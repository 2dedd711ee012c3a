// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/laser_stems.hpp"

namespace waymark::localization {

void register_laser_stems(DetectorTable& detectors);
void register_laser_stems(DetectorTable& detectors) {
  detectors.add({.name = "stems",
                 .summary = "Stems of trees; like those of a park unless the log has the width of the beams",
                 .record = "laser",
                 .types = {"tree"},
                 .finds_single_objects = true,
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   return [tree = type_in_map(types, "tree")](const LaserScan& scan) {
                     LaserStemOptions options = scan.beam_width ? forest_stem_options() : LaserStemOptions{};
                     options.type = tree;
                     return sightings_of_stems(scan, options);
                   };
                 }});
}

}  // namespace waymark::localization
