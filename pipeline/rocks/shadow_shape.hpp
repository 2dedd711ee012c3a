// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "core/units.hpp"
#include "pipeline/rocks/shadow_map.hpp"
namespace waymark::pipeline {

/// Image axes along the light: `along` away from the sun, `across` a quarter turn further.
struct LightFrame {
  double ux = -1, uy = 0;  ///< unit vector away from the sun, pixels

  static LightFrame of(Radians towards_sun) {
    return {-std::cos(towards_sun.value), -std::sin(towards_sun.value)};
  }
  double along(double x, double y) const { return ux * x + uy * y; }
  double across(double x, double y) const { return ux * y - uy * x; }
};

/// Moments of one shadow, weighted by the covered fraction of each pixel.
struct ShadowShape {
  double area = 0;                                                 ///< sum of alpha, pixels
  double x = 0, y = 0;                                             ///< centroid, pixels of the image
  double along_variance = 0, across_variance = 0, covariance = 0;  ///< about it, px^2
  double peak = 0;   ///< maximum of the smoothed map above the base
  int cells = 0;     ///< pixels of the segment, without the ring
  bool cut = false;  ///< touches the border of the map
};

/// Measures the pixels of a segment and a ring of one pixel about it, with alpha above the base of the
/// segment. In the ring, pixels of other shadows are excluded and the mean of clipped noise is subtracted.
ShadowShape measure_shadow(const ShadowMap& map, const ShadowSegment& segment, const LightFrame& light);

}  // namespace waymark::pipeline
