// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/body_radius.hpp"

#include <cmath>

namespace waymark::pipeline {

std::optional<BodyIndex> body_index(const LandmarkType& type) {
  if (type.body.feature.empty()) return std::nullopt;
  return BodyIndex{feature_index(type, type.body.feature), type.body.radius_per_value};
}

std::optional<BodyRadius> body_radius(const std::optional<BodyIndex>& size, const FeatureSet& features) {
  if (!size || size->feature >= features.size()) return std::nullopt;
  const FeatureValue& f = features[size->feature];
  if (!f.known() || !(f.value > 0) || !std::isfinite(f.value)) return std::nullopt;
  const double variance = f.variance > 0 && std::isfinite(f.variance) ? f.variance : 0;
  return BodyRadius{f.value * size->radius_per_value, variance / (f.value * f.value)};
}

}  // namespace waymark::pipeline
