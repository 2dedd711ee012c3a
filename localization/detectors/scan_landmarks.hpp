// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "core/options.hpp"
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of landmark detection in laser scans.
struct ScanDetectionOptions {
  std::string find = "auto";  ///< `stems`, `rocks`; `auto`: the types of the map, rocks if it has both
  bool features = true;       ///< give diameters and radii to the sightings

  void describe(OptionVisitor& option);
};

/// Types of the map; absent: the sightings have no type.
struct ScanTypes {
  std::optional<TypeId> tree, rock;
};

/// Detects landmarks in a scan. Uses the stem options for forests if the log gives the width of the beams,
/// otherwise those for single trees in a park.
SightingSet sightings_of_scan(const LaserScan& scan, const ScanTypes& types,
                              const ScanDetectionOptions& options);

}  // namespace waymark::localization
