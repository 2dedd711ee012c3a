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
  double roughness = 1;          ///< m: RMS by which ranges may differ from those of a cylinder; bushes do
  double rough_base = 1;         ///< m, and by no more than this
  double rough_share = 0;        ///< and this share of the diameter: a thin stem is smoother
  int least_beams = 1;           ///< fewer are no stem
  double range_sd = 0.3;         ///< m; 0: what the scan itself says
  double bearing_sd = 0.02;      ///< rad; 0: what the scan itself says
  bool partly_hidden = false;    ///< take stems beside something nearer too, where their shape is whole
};

/// For a machine among trees: bushes are told from stems, errors are those of the scan.
LaserStems forest_stems();

struct Stem {
  double range = 0, bearing = 0;  ///< of its middle, m and rad
  double diameter = 0;            ///< m
  int beams = 0;
  double roughness = 0;    ///< m, RMS of the ranges about a cylinder
  double range_sd = 0.05;  ///< m
  double bearing_sd = 0.005;
  double diameter_sd = 0.03;
};

/// Clusters of beams that stand before their background on both sides, are as wide as a stem and as round.
/// The diameter is that of the cylinder of this angular width w, less what the beam's own width adds:
/// D = 2 r sin(w/2) / (1 - sin(w/2)) with r the nearest range (Ringdahl et al. 2013); the middle is where the
/// ranges of the inner beams put such a cylinder. A single odd beam amid others is bridged.
/// 5 us per scan of 361 beams.
std::vector<Stem> find_stems(const LaserScan& scan, const LaserStems& options);

SightingSet sightings_of_stems(const LaserScan& scan, const LaserStems& options);

}  // namespace waymark
