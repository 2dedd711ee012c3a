// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "geo/image_source.hpp"
#include "pipeline/rocks/light_coherence.hpp"
#include "pipeline/rocks/shaded_ground.hpp"
#include "pipeline/vision/sun_angle.hpp"
namespace waymark::pipeline {

/// Returns the direction towards the sun that the craters of the central 1024 x 1024 pixels show;
/// `std::nullopt` if there are hardly any, or if they may be rocks. Fewer than 40 that are rather boulders
/// under the opposite sun give that one. The standard deviation is that of their mean.
std::optional<SunAngle> crater_sun_angle(const Pixels& image);

/// Returns the direction towards the sun that rocks and craters show together (estimate_rock_sun_angle), else
/// that of the craters alone; `std::nullopt` if neither is clear.
std::optional<Radians> sun_angle_of_ground(const Pixels& image);

/// Returns the direction towards the sun that the craters of an image show (estimate_crater_sun_angle), or
/// the opposite one where rocks show that and are more: boulders are craters under the opposite sun.
/// `shadows` counts these craters or boulders; `std::nullopt` if fewer than three are visible.
std::optional<SunAngle> sun_angle_for_craters(const Pixels& image);

/// Returns the direction towards the sun that rocks and craters show together (estimate_rock_sun_angle). It
/// is the opposite one where ten or more craters show that and are more; `std::nullopt` if it is not clear.
std::optional<SunAngle> sun_angle_for_rocks(const Pixels& image);

/// Returns the warning about ground on which the detector of rocks cannot be trusted.
std::string unusual_ground_warning(const LightCoherence& seen);

/// Returns the warning about an image that lies in shadow for a good part.
std::string shaded_ground_warning(const ShadedGround& seen);

}  // namespace waymark::pipeline
