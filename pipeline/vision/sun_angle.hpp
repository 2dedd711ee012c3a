// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark {

/// Direction of the light, read off the image itself.
struct SunAngle {
  Radians angle;    ///< towards the sun, in the image from x (right) towards y (down), (-pi, pi]
  Radians sd;       ///< standard deviation of `angle`
  int shadows = 0;  ///< pairs of shadow and lit side that agreed
};

/// Pools the small dark spots of an image with the bright spots beside them: things that stand on the ground
/// are lit on the sun's side of their shadow. Nothing where too few pairs agree (no rocks, no light).
/// Hollows look like rocks under the opposite sun, so an image of craters alone gives the opposite direction:
/// estimate_crater_sun_angle (pipeline/craters) is for those.
/// `max_extent` is the size of the largest spots looked at, pixels.
std::optional<SunAngle> estimate_sun_angle(const Pixels& image, int max_extent = 16);

}  // namespace waymark
