// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/body_radius.hpp"

#include <cmath>

namespace waymark::pipeline {

std::optional<BodySize> body_size(const LandmarkType& type) {
  if (type.size_feature == "radius") return BodySize{feature_index(type, "radius"), 1};
  if (type.size_feature.ends_with("diameter")) return BodySize{feature_index(type, type.size_feature), 0.5};
  return std::nullopt;
}

std::optional<BodyRadius> body_radius(const std::optional<BodySize>& size, const FeatureSet& features) {
  if (!size || size->feature >= features.size()) return std::nullopt;
  const FeatureValue& f = features[size->feature];
  if (!f.known() || !(f.value > 0) || !std::isfinite(f.value)) return std::nullopt;
  const double variance = f.variance > 0 && std::isfinite(f.variance) ? f.variance : 0;
  return BodyRadius{f.value * size->radius_per_value, variance / (f.value * f.value)};
}

}  // namespace waymark::pipeline
