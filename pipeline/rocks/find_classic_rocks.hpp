// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "pipeline/rocks/find_rocks.hpp"
namespace waymark {

/// Method `classic`, kept as the reference the paper cites (Golombek et al. 2008; ROSCO, nasa-jpl): one
/// maximum entropy threshold per tile of 500 px after a gamma of 1.2, connected dark areas, the ellipse of
/// equal second moments and area; width across the light, reach along it, the rock at the sunward end. The
/// light's direction is known. Confidence is the contrast of the shadow's two ends, not calibrated.
std::vector<Detection> find_classic_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle);

/// Threshold that maximises the summed entropies of the two classes (Kapur, Sahoo & Wong 1985): values of
/// bins [0, result] are dark. 0 for an empty histogram.
int maximum_entropy_threshold(std::span<const double> histogram);

}  // namespace waymark
