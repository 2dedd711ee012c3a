// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of the detector of tree stems (or round posts) for a level line scanner.
struct LaserStemOptions {
  std::optional<TypeId> type;        ///< of the sightings
  std::size_t diameter_feature = 1;  ///< index of the diameter among the features of the type
  double jump = 0.5;                 ///< m between neighbouring beams that separates two objects
  double clear = 1.0;                ///< m by which the background must be farther away
  double max_diameter = 1.5;         ///< m
  double min_diameter = 0.02;        ///< m
  double max_range = 70;             ///< m; too few beams hit a stem farther away
  double roughness = 1;              ///< m: largest RMS of the ranges about a cylinder; bushes exceed it
  double roughness_base = 1;         ///< m: limit of the RMS for a diameter of 0
  double roughness_per_metre = 0;  ///< increase of that limit per metre of diameter: thin stems are smoother
  int min_beams = 1;               ///< per stem
  double range_sd = 0.3;           ///< m; 0: estimated from the scan
  double bearing_sd = 0.02;        ///< rad; 0: estimated from the scan
  bool partly_hidden = false;      ///< accept stems beside a nearer object if their shape is whole
};

/// Returns options for a machine in a forest: rejects bushes and estimates errors from the scan.
LaserStemOptions forest_stem_options();

/// Returns options for lamps, masts and bollards up to 0.3 m wide.
LaserStemOptions post_options();
/// Returns options for round columns from 0.3 to 2 m wide.
LaserStemOptions pillar_options();

/// A stem detected in a laser scan.
struct Stem {
  double range = 0, bearing = 0;  ///< of its centre, m and rad
  double diameter = 0;            ///< m
  int beams = 0;
  double roughness = 0;    ///< m, RMS of the ranges about a cylinder
  double range_sd = 0.05;  ///< m
  double bearing_sd = 0.005;
  double diameter_sd = 0.03;
};

/// Detects stems: clusters of beams in front of their background on both sides with the width and the shape
/// of a cylinder. 5 us per scan of 361 beams.
/// - The diameter is that of the cylinder of the angular width w less the beam's own width: D = 2 r
///   sin(w/2) / (1 - sin(w/2)), r the nearest range (Ringdahl et al. 2013).
/// - The centre is where the ranges of the inner beams put such a cylinder.
/// - A single outlying beam among others is bridged.
std::vector<Stem> find_stems(const LaserScan& scan, const LaserStemOptions& options);

/// Detects stems in a scan and returns them as sightings.
SightingSet sightings_of_stems(const LaserScan& scan, const LaserStemOptions& options);

}  // namespace waymark::localization
