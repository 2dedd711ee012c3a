// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <limits>
#include "core/feature.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::localization {

/// Number of features that localization compares: the first eight, in the order of the type. Built-in types
/// have at most five.
inline constexpr std::size_t kMaxFeatures = 8;

/// Feature values in fixed arrays, so that millions lie side by side. NaN: unknown.
struct KnownFeatures {
  KnownFeatures() {
    value.fill(std::numeric_limits<double>::quiet_NaN());
    variance.fill(0);
  }
  std::array<double, kMaxFeatures> value;
  std::array<double, kMaxFeatures> variance;  ///< of the value's error

  bool known(std::size_t i) const { return std::isfinite(value[i]); }
};

/// Returns the merged values of the map. The variance is the spread of the observations: conservative, and
/// right for an object that looks different from each side.
KnownFeatures known_features(const FeatureSet& features);

}  // namespace waymark::localization
