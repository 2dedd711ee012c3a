// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark::pipeline {

/// Crater measured in a grid of heights with square cells. Lengths in cells, heights in the unit of the
/// grid.
struct DemRim {
  double x = 0, y = 0;
  double major = 0, minor = 0, angle = 0;  ///< as PixelEllipse
  double rim_height = 0;                   ///< median rim crest
  double depth = 0, depth_sd = 0;          ///< median crest minus floor; sd of that median
  double low_rim = 0;                      ///< 15th percentile of crest minus floor over the azimuths
  double spread = 0;                       ///< residual of the crest about the fitted rim, in radii
  double known_fraction = 1;               ///< fraction of azimuths without missing data
};

/// Fits the rim crest of a crater in a DEM; `std::nullopt` if fewer than 12 azimuths are known.
/// - Crest: the highest point along each of 24 azimuths between 0.65 and 1.4 radii, above the plane through
///   the surroundings; an ellipse is fitted as in refine_rim.
/// - Floor: 20th percentile of the heights within half a radius.
std::optional<DemRim> measure_dem_rim(const Pixels& heights, const CraterCandidate& candidate);

}  // namespace waymark::pipeline
