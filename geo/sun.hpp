// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/frames.hpp"
#include "core/units.hpp"
namespace waymark {

/// Where the light comes from, seen from the ground.
struct Sun {
  Degrees azimuth{0};    ///< towards the sun, clockwise from grid north, [0, 360)
  Degrees elevation{0};  ///< above the horizontal
  Degrees sd{0.5};       ///< of either angle

  friend bool operator==(const Sun&, const Sun&) = default;
};

/// Unit vector from the ground to the sun.
Direction<GridFrame> towards(const Sun& sun);

}  // namespace waymark
