// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Illumination of a bowl template.
enum class BowlLight {
  slope,        ///< brightness proportional to the slope along the light: shallow bowls, high sun
  low_shadow,   ///< fresh bowl, sun 25 degrees high: the near wall is in its own shadow
  deep_shadow,  ///< fresh bowl, sun 12 degrees high: the floor is in shadow as well
};

/// Returns the appearance of a crater of `diameter` pixels: a paraboloid with a rim that falls as r^-3
/// outside, blurred by 0.7 px. `sun_angle` points towards the sun, from x towards y. The result is a square
/// of odd side, 1.3 diameters, centred on the crater, with zero mean and unit norm.
Pixels bowl_template(double diameter, Radians sun_angle, BowlLight light);

}  // namespace waymark::pipeline
