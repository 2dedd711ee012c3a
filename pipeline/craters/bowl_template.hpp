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
  flat_floor,   ///< as slope, with a level floor out to 0.65 radii: partly filled
  rim_only,     ///< a level floor out to 0.75 radii and a ridge: filled to the plain
};

/// Returns the brightness at (u, v) radii from the centre of a bowl, light from +u; not normalised.
double bowl_brightness(double u, double v, BowlLight light);

/// Returns the appearance of a crater of `diameter` pixels: a paraboloid with a rim that falls as r^-3
/// outside, blurred by 0.7 px. `sun_angle` points towards the sun, from x towards y. The result is a square
/// of odd side, 1.3 diameters, centred on the crater, with zero mean and unit norm.
Pixels bowl_template(double diameter, Radians sun_angle, BowlLight light);

}  // namespace waymark::pipeline
