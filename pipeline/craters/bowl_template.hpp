// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark {

/// How a bowl is lit.
enum class BowlLight {
  slope,        ///< brightness follows the slope along the light: shallow bowls, high sun
  low_shadow,   ///< a fresh bowl, sun 25 degrees high: the near wall lies in its own shadow
  deep_shadow,  ///< the same, sun 12 degrees high: the floor too
};

/// How a crater of `diameter` pixels looks: a paraboloid with a rim that falls as r^-3 outside, lit from
/// `sun_angle` (towards the sun, from x towards y), blurred by 0.7 px. A square of odd side, 1.3 diameters,
/// the crater in the middle; zero mean and unit norm over the square.
Pixels bowl_template(double diameter, Radians sun_angle, BowlLight light);

}  // namespace waymark
