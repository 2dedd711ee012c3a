// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of the rock detector for a line scanner close above the ground.
struct LaserRockOptions {
  std::optional<TypeId> type;  ///< of the sightings; its first feature is the radius (as `rock`)
  double jump = 0.35;          ///< m between neighbouring beams that separates two objects
  double clear = 0.5;          ///< m by which the background must be farther away
  double min_width = 0.2;      ///< m
  double max_width = 5;        ///< m; wider arcs are ground
  double max_range = 25;       ///< m
  int min_beams = 3;
  double roughness = 0.2;       ///< RMS of the ranges about an arc, fraction of the width
  double min_bulge = -0.05;     ///< how far the ends lie behind the middle, fraction of the width
  double taper = 1.12;          ///< outline on the ground over the width at the height of the scanner
  double radius_spread = 0.22;  ///< relative standard deviation: rocks are not round, and partly hidden
};

/// A rock detected in a laser scan.
struct LaserRock {
  double range = 0, bearing = 0;  ///< of its centre, m and rad
  double radius = 0;              ///< m, at the height of the scanner
  int beams = 0;
  double bulge = 0;  ///< m: how far the ends of the arc lie behind its middle
  double range_sd = 0.1, bearing_sd = 0.01;
};

/// Detects rocks: arcs of beams in front of their background on both sides that bulge towards the scanner
/// and are not too wide. Ground that rises into the beam makes wide or rough arcs; some of these are false
/// alarms.
std::vector<LaserRock> find_rocks(const LaserScan& scan, const LaserRockOptions& options);

/// Detects rocks in a scan and returns them as sightings.
SightingSet sightings_of_rocks(const LaserScan& scan, const LaserRockOptions& options);

}  // namespace waymark::localization
