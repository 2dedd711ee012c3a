// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "pipeline/fusion/cleaning/rejections.hpp"

namespace waymark::pipeline {
namespace {

const FeatureValue* known(const Observation& o, const LandmarkType& type, std::string_view name) {
  for (std::size_t i = 0; i < type.features.size() && i < o.features.size(); ++i)
    if (type.features[i].name == name && o.features[i].known()) return &o.features[i];
  return nullptr;
}

std::string fault(const Observation& o, const LandmarkType& type, const PlausibilityRules& rules) {
  const FeatureValue *depth = known(o, type, "depth"), *radius = known(o, type, "radius");
  if (depth && depth->value + 2 * std::sqrt(depth->variance) < 0) return "negative depth";
  if (depth && radius &&
      depth->value + 2 * std::sqrt(depth->variance) < rules.min_depth_ratio * 2 * radius->value)
    return "too shallow";
  const FeatureValue* height = known(o, type, "height");
  if (type.drawn_as == Solid::cylinder && height && radius &&
      height->value - 2 * std::sqrt(height->variance) > rules.max_height_ratio * 2 * radius->value)
    return "too tall";
  for (std::size_t i = 0; i < type.features.size() && i < o.features.size(); ++i) {
    const FeatureSpec& spec = type.features[i];
    const FeatureValue& f = o.features[i];
    if (!f.known() || spec.name == "depth") continue;
    if (!(f.value >= spec.min_value && f.value <= spec.max_value)) return "implausible " + spec.name;
  }
  return {};
}

}  // namespace

void reject_implausible(std::span<Observation> observations, const TypeRegistry& types,
                        const PlausibilityRules& rules) {
  for (Observation& o : observations)
    if (o.rejected.empty()) o.rejected = fault(o, types[o.type], rules);
}

}  // namespace waymark::pipeline
