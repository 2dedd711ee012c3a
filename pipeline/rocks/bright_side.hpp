// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/rocks/shadow_map.hpp"
namespace waymark::pipeline {

/// Dark spot of a shadow map.
struct SpotDisc {
  double x = 0, y = 0;  ///< centroid, pixels
  double area = 0;      ///< pixels
  double peak = 0;      ///< largest shadow fraction
};

/// Direction from a dark spot towards the brighter part of its surroundings.
struct BrightSide {
  double angle = 0;   ///< from x (right) towards y (down), radians
  double weight = 0;  ///< one-sidedness squared times the amount of light, [0, 1]; 0: no light nearby
};

/// Computes the first moment of the brightness above the ground, in a disc about twice as wide as the spot.
/// Rocks and slopes under the sun are bright on the side of the sun, hollows on the opposite side.
BrightSide bright_side(const ShadowMap& map, const SpotDisc& spot);

}  // namespace waymark::pipeline
