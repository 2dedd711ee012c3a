// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark {

/// A crater measured in a grid of heights with square cells. Lengths in cells, heights in the grid's unit.
struct DemRim {
  double x = 0, y = 0;
  double major = 0, minor = 0, angle = 0;  ///< as PixelEllipse
  double rim_height = 0;                   ///< median of the crest
  double depth = 0, depth_sd = 0;          ///< median crest less floor; sd of that median
  double weakest = 0;                      ///< 15th percentile of crest less floor over the azimuths
  double spread = 0;                       ///< of the crest's radius about the fitted rim, in radii
  double complete = 1;                     ///< share of azimuths along which all is known
};

/// The highest point along each of 24 azimuths between 0.65 and 1.4 radii, above the plane through the
/// surroundings; an ellipse through them as in refine_rim; the floor is the 20th percentile of the
/// heights within half a radius.
/// Nothing where fewer than 12 azimuths are known.
std::optional<DemRim> measure_dem_rim(const Pixels& heights, const CraterCandidate& candidate);

}  // namespace waymark
