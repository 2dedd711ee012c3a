// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark {

/// What a level line scanner takes for a tree stem (or any round post).
struct LaserStems {
  std::optional<TypeId> type;    ///< given to the sightings; its second feature is the diameter (as `tree`)
  double jump = 0.5;             ///< m between neighbouring beams that parts two things
  double clear = 1.0;            ///< m by which what stands beside must be farther away
  double most_diameter = 1.5;    ///< m
  double least_diameter = 0.02;  ///< m
  double most_range = 70;        ///< m; a stem farther away is hit by too few beams
  double range_sd = 0.3;         ///< m
  double bearing_sd = 0.02;      ///< rad
};

struct Stem {
  double range = 0, bearing = 0;  ///< of its middle, m and rad
  double diameter = 0;            ///< m
  int beams = 0;
};

/// Clusters of beams that stand before their background on both sides and are as wide as a stem. 5 us per
/// scan of 361 beams.
std::vector<Stem> find_stems(const LaserScan& scan, const LaserStems& options);

SightingSet sightings_of_stems(const LaserScan& scan, const LaserStems& options);

}  // namespace waymark
