// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"

namespace waymark::pipeline {
namespace {

const FeatureValue* known(const Observation& o, const LandmarkType& type, std::string_view name) {
  for (std::size_t i = 0; i < type.features.size() && i < o.features.size(); ++i)
    if (type.features[i].name == name && o.features[i].known()) return &o.features[i];
  return nullptr;
}

std::string fault(const Observation& o, const LandmarkType& type, const PlausibilityRules& rules) {
  const bool bowl = type.evidence == EvidenceModel::bowl;
  const auto body = body_radius(body_index(type), o.features);
  if (const FeatureValue* depth = bowl ? known(o, type, "depth") : nullptr) {
    const double upper = depth->value + 2 * std::sqrt(depth->variance);
    if (upper < 0) return "negative depth";
    if (body && upper < rules.min_depth_ratio * 2 * body->metres) return "too shallow";
  }
  const FeatureValue* height = known(o, type, "height");
  if (type.evidence == EvidenceModel::shadow_caster && height && body &&
      height->value - 2 * std::sqrt(height->variance) > rules.max_height_ratio * 2 * body->metres)
    return "too tall";
  for (std::size_t i = 0; i < type.features.size() && i < o.features.size(); ++i) {
    const FeatureSpec& spec = type.features[i];
    const FeatureValue& f = o.features[i];
    if (!f.known() || (bowl && spec.name == "depth")) continue;  // judged above
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
