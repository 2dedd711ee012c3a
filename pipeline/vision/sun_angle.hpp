// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Direction of the light, estimated from the image.
struct SunAngle {
  Radians angle;    ///< towards the sun, in the image from x (right) towards y (down), (-pi, pi]
  Radians sd;       ///< standard deviation of `angle`
  int shadows = 0;  ///< pairs of shadow and lit side that agree
};

/// Estimates the direction of light from small dark spots and the bright spots beside them; `std::nullopt`
/// if too few pairs agree.
/// - Objects on the ground are lit on the sunward side of their shadow.
/// - Hollows resemble rocks under the opposite sun; for cratered terrain use estimate_crater_sun_angle
///   (pipeline/craters).
/// - `max_extent` is the size of the largest spots used, pixels.
std::optional<SunAngle> estimate_sun_angle(const Pixels& image, int max_extent = 16);

}  // namespace waymark::pipeline
