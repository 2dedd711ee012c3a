// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
namespace waymark::pipeline {

/// Heights of a crater measured in the terrain.
struct BowlDepth {
  double rim_height = 0;  ///< metres, median of the crest over 36 azimuths
  double depth = 0;       ///< metres, rim height minus floor (lowest tenth within 0.4 radii); may be negative
  double depth_sd = 0;    ///< from heights and rim unevenness; excludes shape errors of a coarse terrain
};

/// Returns `std::nullopt` if the crater is narrower than five cells of the terrain or the terrain ends inside
/// it.
std::optional<BowlDepth> bowl_depth(const Terrain& terrain, const GroundOutline& outline);

}  // namespace waymark::pipeline
