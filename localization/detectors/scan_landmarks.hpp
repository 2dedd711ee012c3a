// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "core/options.hpp"
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark {

/// What laser scans are searched for.
struct ScanLandmarks {
  std::string find = "auto";  ///< `stems`, `rocks`; `auto`: what the map has, rocks where it has both
  bool features = true;       ///< give diameters and radii to the sightings

  void describe(OptionVisitor& option);
};

/// Types the map has; sightings of others have none.
struct ScanTypes {
  std::optional<TypeId> tree, rock;
};

/// Landmarks in a scan. Stems are searched with the settings for forests where the log tells the width of the
/// beams, with those for single trees in a park otherwise.
SightingSet sightings_of_scan(const LaserScan& scan, const ScanTypes& types, const ScanLandmarks& options);

}  // namespace waymark
