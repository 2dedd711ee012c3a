// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/detection.hpp"
#include "geo/sun.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"
namespace waymark::pipeline {

/// Returns the height of an object from the length of its shadow on sloping ground:
///   H = L (tan e + f g)
/// L is the horizontal length of the shadow, e the sun's elevation, g the rise of the ground per metre away
/// from the sun. The reach is converted to metres along the shadow's direction on the ground, which corrects
/// oblique views.
/// - `slope_sd` is the standard deviation of g.
/// - `slope_response`, f, is the response of the detected reach to the slope: 1 if measured, less if the
/// detector
///   relies on the expected shape of rocks.
/// `std::nullopt` if the sun is below the ground's own horizon (tan e + g <= 0.02) or the shadow's direction
/// is not visible.
std::optional<MeasuredValue> height_from_shadow(const MeasuredValue& reach_px, const ImageView& image,
                                                const GroundPlane& ground, const Sun& sun, double slope_sd,
                                                double slope_response = 1);

/// Returns the log of the factor by which the slope shortens shadows, ln((tan e + g) / tan e), clamped to
/// +-ln 2.
/// 0 for a sun in the zenith or not above the level horizon.
double log_shadow_shortening(const GroundPlane& ground, const Sun& sun);

}  // namespace waymark::pipeline
