// SPDX-License-Identifier: Apache-2.0
#include "core/landmark.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace waymark::inline core {

std::optional<double> multiplicity_confidence(int seen, int visible) {
  if (visible <= 0) return std::nullopt;
  return std::clamp(static_cast<double>(seen) / visible, 0.0, 1.0);
}

std::optional<double> spread_confidence(const FeatureValue& feature, Scale scale, double reference,
                                        SpreadRule rule) {
  if (!feature.known()) return std::nullopt;
  const double spread = std::sqrt(feature.variance);
  if (rule == SpreadRule::paper) {
    if (spread == 0 || feature.observations < 2) return 1.0;
    if (feature.value == 0) return std::nullopt;
    return std::clamp(1 - spread / feature.value, 0.0, 1.0);
  }
  if (feature.observations < 2) return std::nullopt;
  const double unit = scale == Scale::ratio ? std::abs(feature.value) : reference;
  if (!(unit > 0)) return std::nullopt;
  return std::clamp(1 - spread / unit, 0.0, 1.0);
}

std::optional<double> landmark_quality(std::optional<double> multiplicity,
                                       std::span<const std::optional<double>> feature_confidences,
                                       std::span<const double> weights) {
  assert(feature_confidences.size() == weights.size());
  if (!multiplicity) return std::nullopt;
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < feature_confidences.size(); ++i) {
    if (!feature_confidences[i]) continue;
    sum += weights[i] * *feature_confidences[i];
    total += weights[i];
  }
  return *multiplicity * (total > 0 ? sum / total : 1.0);
}

}  // namespace waymark::inline core
