// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "geo/image_source.hpp"
#include "pipeline/vision/sun_angle.hpp"
namespace waymark::pipeline {

/// Estimates the direction towards the sun for the detection of rocks; `std::nullopt` if it is not clear.
/// - Axis: dark spots of bare ground have their bright side along the light, whether rock, slope or hollow.
///   Leaves and buildings have no such axis.
/// - Side: that of `craters` (estimate_crater_sun_angle, its count as `shadows`) where ten or more agree with
///   the axis. Otherwise the side on which dark spots are bright, then that of boulders. Contradictions give
///   `std::nullopt`.
/// Uses the central 1000 x 1000 pixels.
std::optional<SunAngle> estimate_rock_sun_angle(const Pixels& image, std::optional<SunAngle> craters = {});

/// Returns the number of rocks of `min_diameter` pixels or more that light from `sun_angle` shows in the
/// image: the sum of their confidences.
double count_rocks(const Pixels& image, Radians sun_angle, double min_diameter);

/// Returns the number of boulders, rocks of 20 pixels or more: count_rocks.
double count_boulders(const Pixels& image, Radians sun_angle);

}  // namespace waymark::pipeline
