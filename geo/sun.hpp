// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/frames.hpp"
#include "core/units.hpp"
namespace waymark::inline geo {

/// Position of the sun, seen from the ground.
struct Sun {
  Degrees azimuth{0};    ///< direction to the sun, clockwise from grid north, [0, 360)
  Degrees elevation{0};  ///< above the horizontal
  Degrees sd{0.5};       ///< of either angle

  friend bool operator==(const Sun&, const Sun&) = default;
};

/// Returns the unit vector from the ground to the sun.
Direction<GridFrame> sun_direction(const Sun& sun);

}  // namespace waymark::inline geo
