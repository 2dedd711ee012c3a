// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/feature_distance.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace waymark::localization {

FeatureScales::FeatureScales(const TypeRegistry& types) {
  for (const LandmarkType& type : types) {
    auto& scales = scales_.emplace_back();
    scales.fill(Scale::ratio);
    for (std::size_t i = 0; i < std::min(type.features.size(), kMaxFeatures); ++i)
      scales[i] = type.features[i].scale;
    reaches_.push_back(type.identification_reach);
  }
}

double FeatureScales::difference(TypeId type, std::size_t feature, double a, double b) const {
  return type < scales_.size() ? waymark::difference(a, b, scales_[type][feature]) : a - b;
}

bool FeatureScales::has_axis(TypeId type) const {
  return type < scales_.size() && std::ranges::find(scales_[type], Scale::axis) != scales_[type].end();
}

double FeatureScales::identification_reach(std::optional<TypeId> type) const {
  if (type && *type < reaches_.size()) return reaches_[*type];
  return reaches_.empty() ? LandmarkType{}.identification_reach : std::ranges::min(reaches_);
}

KnownFeatures features_in_map(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                              double sensor_yaw, double yaw_variance) {
  KnownFeatures mapped = seen;
  if (!scales.has_axis(type)) return mapped;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!seen.known(i) || !scales.is_axis(type, i)) continue;
    mapped.value[i] = std::remainder(std::numbers::pi / 2 - sensor_yaw - seen.value[i], std::numbers::pi);
    mapped.variance[i] += yaw_variance;
  }
  return mapped;
}

KnownFeatures features_without_axes(const FeatureScales& scales, TypeId type, KnownFeatures seen) {
  if (!scales.has_axis(type)) return seen;
  for (std::size_t i = 0; i < kMaxFeatures; ++i)
    if (scales.is_axis(type, i)) seen.value[i] = std::numeric_limits<double>::quiet_NaN();
  return seen;
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

}  // namespace waymark::localization
