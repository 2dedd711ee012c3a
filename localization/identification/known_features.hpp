// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <limits>
#include "core/feature.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// Features of a type that localization compares: the first eight, in the order of the type. Types of ours
/// have at most five.
inline constexpr std::size_t kMaxFeatures = 8;

/// Feature values without memory of their own, so that millions lie side by side. NaN: not known.
struct KnownFeatures {
  KnownFeatures() {
    value.fill(std::numeric_limits<double>::quiet_NaN());
    variance.fill(0);
  }
  std::array<double, kMaxFeatures> value;
  std::array<double, kMaxFeatures> variance;  ///< of the value's error

  bool known(std::size_t i) const { return std::isfinite(value[i]); }
};

/// What the map knows: merged values. Their error is taken as the spread of the observations, which is
/// cautious (the mean is better than that) and right for a thing that looks different from each side.
KnownFeatures known_features(const FeatureSet& features);

}  // namespace waymark
