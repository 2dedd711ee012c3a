// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "core/landmark.hpp"
namespace waymark::inline landmarks {

/// Returns whether the observations say anything about a landmark's quality: two images could have shown it,
/// or a feature with a weight has a confidence. Seen once of once, eq. 8 would give 1, which no observation
/// supports. By the paper's letter (SpreadRule::paper) features observed once have a confidence, so eq. 8
/// applies.
inline bool is_quality_assessed(const Quality& quality, std::span<const double> weights) {
  if (quality.visible > 1) return true;
  for (std::size_t i = 0; i < quality.feature_confidences.size() && i < weights.size(); ++i)
    if (quality.feature_confidences[i] && weights[i] > 0) return true;
  return false;
}

}  // namespace waymark::inline landmarks
