// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/ground_outline.hpp"
namespace waymark {

/// A crater's heights as the terrain tells them.
struct BowlDepth {
  double rim_height = 0;  ///< metres, median of the crest over 36 azimuths
  double depth = 0;       ///< metres, rim height minus floor (lowest tenth within 0.4 radii); may be negative
  double depth_sd = 0;  ///< of the terrain's heights and the unevenness of the rim; shape errors of a coarse
                        ///< terrain are not in it
};

/// Nothing where the crater is less than five cells wide (the terrain cannot show its depth) or the terrain
/// ends inside it.
std::optional<BowlDepth> bowl_depth(const Terrain& terrain, const GroundOutline& outline);

}  // namespace waymark
