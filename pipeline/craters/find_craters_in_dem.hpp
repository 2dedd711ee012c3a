// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <vector>
#include "core/detection.hpp"
#include "geo/dem_source.hpp"
namespace waymark::pipeline {

/// Parameters of the crater search in a window of a DEM.
struct DemCraterSearch {
  double cell_width = 1, cell_height = 1;  ///< metres, > 0
  double min_diameter = 9;                 ///< in cells of the coarser direction, >= 6
  double max_diameter = 0;                 ///< in cells; 0: 0.6 times the window's shorter side
  double min_confidence = 0.5;
};

/// Crater of a DEM. Horizontal lengths are in metres.
struct DemCrater {
  double column = 0, row = 0;   ///< centre; (0, 0) is the centre of the window's first cell
  double major = 0, minor = 0;  ///< full axes of the rim crest, metres
  double angle = 0;             ///< of the major axis, radians from x (east) towards y (south), (-pi/2, pi/2]
  double centre_sd = 0;         ///< of either coordinate, metres
  double diameter_sd = 0;       ///< metres
  double rim_height = 0;        ///< median height of the rim crest, metres
  double depth = 0, depth_sd = 0;  ///< median rim to floor, metres
  double confidence = 1;           ///< calibrated probability, (0, 1]

  double diameter() const { return std::sqrt(major * minor); }
};

/// Returns the craters whose centres lie in the window, by descending confidence. Cells without height are
/// no data. Bowls are correlated over scales, then the rim is compared with the floor along 24 azimuths.
/// Craters with depth / diameter below 0.02 are not found; lunar maria have them down to 0.003. Throws
/// Error{usage} for sizes out of order.
std::vector<DemCrater> find_craters(const HeightWindow& heights, const DemCraterSearch& search);

}  // namespace waymark::pipeline
