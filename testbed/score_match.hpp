// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "testbed/score.hpp"
namespace waymark {

/// Per find the index of its true thing or -1. Deterministic: ties by index.
struct Pairing {
  std::vector<int> truth_of;  ///< per find
  std::vector<bool> near;     ///< per find: lies in the match radius of some true thing of like size
};
Pairing pair_up(std::span<const ScoredThing> found, std::span<const ScoredThing> truth,
                const MatchRules& rules);

/// Intersection over union of two circles.
double circle_overlap(double distance, double diameter_a, double diameter_b);

}  // namespace waymark
