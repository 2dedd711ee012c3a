// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/feature_distance.hpp"

#include <algorithm>

namespace waymark {

FeatureScales::FeatureScales(const TypeRegistry& types) {
  for (const LandmarkType& type : types) {
    auto& scales = scales_.emplace_back();
    scales.fill(Scale::ratio);
    for (std::size_t i = 0; i < std::min(type.features.size(), kMaxFeatures); ++i)
      scales[i] = type.features[i].scale;
  }
}

double FeatureScales::difference(TypeId type, std::size_t feature, double a, double b) const {
  return type < scales_.size() ? waymark::difference(a, b, scales_[type][feature]) : a - b;
}

FeatureComparison compare_features(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                   const KnownFeatures& mapped, double tolerance) {
  FeatureComparison all;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!seen.known(i)) continue;
    if (!mapped.known(i)) {
      ++all.missing;
      continue;
    }
    const double d = scales.difference(type, i, seen.value[i], mapped.value[i]);
    const double slack = tolerance * std::max(std::abs(mapped.value[i]), 1e-3);
    const double square = d * d / (seen.variance[i] + mapped.variance[i] + slack * slack + 1e-12);
    all.squares += square;
    all.largest = std::max(all.largest, square);
    ++all.used;
  }
  return all;
}

}  // namespace waymark
