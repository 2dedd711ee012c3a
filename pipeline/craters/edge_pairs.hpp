// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/craters/bowl_verification.hpp"
namespace waymark::pipeline {

/// Finds craters from pairs of rim edges (Cheng, Johnson, Matthies & Olson 2003), at octaves from full size
/// down.
/// - Edges whose gradient runs along the light are split into sunward and far rims, each convex away from the
///   centre.
/// - The best pairs along the light are joined by an ellipse (Fitzgibbon, Pilu & Fisher 1999).
/// - Score: 1 / (1 + cost), higher for edges of similar length at the right distance; not a calibrated
///   probability.
std::vector<VerifiedBowl> find_craters_by_edges(const FilledImage& image, Radians sun_angle,
                                                double min_diameter, double max_diameter);

}  // namespace waymark::pipeline
