// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "testbed/score.hpp"
namespace waymark::testbed {

/// Matching of detections to true objects. Deterministic: ties by index.
struct ObjectMatching {
  std::vector<int> truth_index;  ///< per detection: index of its true object, or -1
  std::vector<bool> near;  ///< per detection: within the matching radius of a true object of similar size
};
ObjectMatching match_objects(std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
                             const MatchRules& rules);

/// Returns the intersection over union of two circles.
double circle_overlap(double distance, double diameter_a, double diameter_b);

}  // namespace waymark::testbed
