// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/detection.hpp"
#include "geo/sun.hpp"
#include "pipeline/fusion/sight.hpp"
namespace waymark {

/// Height of a thing from the reach of its shadow on sloping ground, seen from anywhere:
/// H = L (tan e + f g), L the level length of the shadow, e the sun's elevation, g the rise of the ground per
/// metre away from the sun (a shadow that falls downhill is longer than the thing is high).
/// The reach is turned into metres along the shadow's own direction on the ground, which corrects oblique
/// views. `slope_sd` is the standard deviation of g. `follows`, f: how far the reach told follows the length
/// of the shadow; 1 where it is measured. A detector that does not know the slope and leans on what it
/// expects of rocks takes part of the slope's effect out itself. Nothing where the sun is below the ground's
/// own horizon (tan e + g <= 0.02: the ground is in its own shadow) or the shadow's direction is not seen.
std::optional<Measured> height_from_shadow(const Measured& reach_px, const ImageView& image,
                                           const GroundPlane& ground, const Sun& sun, double slope_sd,
                                           double follows = 1);

/// By how much the ground's slope shortens shadows: ln((tan e + g) / tan e), held within ln 2 either way; 0
/// for a sun in the zenith or not above level ground.
double log_steepness(const GroundPlane& ground, const Sun& sun);

}  // namespace waymark
