// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/craters/bowl_verification.hpp"
namespace waymark {

/// The paper's way: rim edges whose gradient runs along the light, split into those that open a crater
/// (bright to dark, seen from the sun) and those that close it (bright to dark again behind the lit wall),
/// each convex away from the crater's middle; the best pairs along the light; an ellipse through both (Cheng,
/// Johnson, Matthies & Olson 2003; Fitzgibbon, Pilu & Fisher 1999). At octaves from full size down. Scores
/// are 1 / (1 + cost): better pairs of alike length and right distance score higher; they are no calibrated
/// probabilities.
std::vector<VerifiedBowl> craters_by_edges(const FilledImage& image, Radians sun_angle, double min_diameter,
                                           double max_diameter);

}  // namespace waymark
