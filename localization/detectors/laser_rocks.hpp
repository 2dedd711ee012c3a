// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark {

/// What a line scanner close above the ground takes for a rock.
struct LaserRocks {
  std::optional<TypeId> type;  ///< given to the sightings; its first feature is the radius (as `rock`)
  double jump = 0.35;          ///< m between neighbouring beams that parts two things
  double clear = 0.5;          ///< m by which what stands beside must be farther away
  double least_width = 0.2;    ///< m
  double most_width = 5;       ///< m; what is wider is ground
  double most_range = 25;      ///< m
  int least_beams = 3;
  double roughness = 0.2;       ///< RMS of the ranges about an arc, share of the width
  double least_bulge = -0.05;   ///< how far the ends lie behind the middle, share of the width
  double taper = 1.12;          ///< outline on the ground over what is seen at the height of the scanner
  double radius_spread = 0.22;  ///< relative: rocks are not round, and more or less of them is seen
};

struct SeenRock {
  double range = 0, bearing = 0;  ///< of its middle, m and rad
  double radius = 0;              ///< m, at the height of the scanner
  int beams = 0;
  double bulge = 0;  ///< m: how far the ends of the arc lie behind its middle
  double range_sd = 0.1, bearing_sd = 0.01;
};

/// Arcs of beams that stand before their background on both sides, bulge towards the scanner and are not too
/// wide. Ground that rises into the beam makes wide or rough arcs; some of it gets through.
std::vector<SeenRock> find_rocks(const LaserScan& scan, const LaserRocks& options);

SightingSet sightings_of_rocks(const LaserScan& scan, const LaserRocks& options);

}  // namespace waymark
