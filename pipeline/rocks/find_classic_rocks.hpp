// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "pipeline/rocks/find_rocks.hpp"
namespace waymark::pipeline {

/// Finds rocks by the method `classic`, the reference cited by the paper (Golombek et al. 2008; ROSCO,
/// nasa-jpl).
/// - One maximum entropy threshold per tile of 500 px after a gamma of 1.2, then connected dark areas.
/// - Each area becomes the ellipse of equal second moments and area: width across the light, reach along
///   it, the rock at the sunward end.
/// - Confidence is the contrast at the two ends of the shadow; it is not calibrated.
std::vector<Detection> find_classic_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle);

/// Returns the threshold that maximises the summed entropies of both classes (Kapur, Sahoo & Wong 1985).
/// Bins [0, result] are dark. 0 for an empty histogram.
int maximum_entropy_threshold(std::span<const double> histogram);

}  // namespace waymark::pipeline
