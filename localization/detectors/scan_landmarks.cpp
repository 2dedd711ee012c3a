// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/scan_landmarks.hpp"

#include "localization/detectors/laser_rocks.hpp"
#include "localization/detectors/laser_stems.hpp"

namespace waymark::localization {

void ScanDetectionOptions::describe(OptionVisitor& option) {
  option("scans", find,
         {.help = "Landmarks to detect in laser scans", .choices = {"auto", "stems", "rocks"}});
  option("scan_features", features, {.help = "Use the diameters and radii measured in scans"});
}

SightingSet sightings_of_scan(const LaserScan& scan, const ScanTypes& types,
                              const ScanDetectionOptions& options) {
  const bool rocks = options.find == "rocks" || (options.find == "auto" && types.rock);
  SightingSet set;
  if (rocks) {
    set = sightings_of_rocks(scan, {.type = types.rock});
  } else {
    LaserStemOptions stems = scan.beam_width ? forest_stem_options() : LaserStemOptions{};
    stems.type = types.tree;
    set = sightings_of_stems(scan, stems);
  }
  if (!options.features)
    for (SeenLandmark& s : set.sightings) s.features = {};
  return set;
}

}  // namespace waymark::localization
