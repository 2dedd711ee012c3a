// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/scan_landmarks.hpp"

#include "localization/detectors/laser_rocks.hpp"
#include "localization/detectors/laser_stems.hpp"

namespace waymark {

void ScanLandmarks::describe(OptionVisitor& option) {
  option("scans", find, {.help = "What laser scans are searched for", .choices = {"auto", "stems", "rocks"}});
  option("scan_features", features, {.help = "Use the diameters and radii measured in scans"});
}

SightingSet sightings_of_scan(const LaserScan& scan, const ScanTypes& types, const ScanLandmarks& options) {
  const bool rocks = options.find == "rocks" || (options.find == "auto" && types.rock);
  SightingSet set;
  if (rocks) {
    set = sightings_of_rocks(scan, {.type = types.rock});
  } else {
    LaserStems stems = scan.beam_width ? forest_stems() : LaserStems{};
    stems.type = types.tree;
    set = sightings_of_stems(scan, stems);
  }
  if (!options.features)
    for (SeenLandmark& s : set.sightings) s.features = {};
  return set;
}

}  // namespace waymark
