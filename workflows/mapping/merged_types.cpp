// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/merged_types.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace waymark::workflows {
namespace {

[[noreturn]] void refuse(const std::string& type, const std::string& what) {
  throw Error(ErrorCode::input, fmt::format("the maps declare type {} differently: {}", type, what), "",
              "make one of the maps again with the declaration of the other, or export and import its " +
                  type + " landmarks with --columns");
}

LandmarkType merge_type(LandmarkType a, const LandmarkType& b) {
  if (a.evidence != b.evidence)
    refuse(a.name, fmt::format("evidence model {} and {}", to_string(a.evidence), to_string(b.evidence)));
  if (a.body != b.body)
    refuse(a.name, fmt::format("its extent is feature '{}' and '{}'", a.body.feature, b.body.feature));
  for (const FeatureSpec& feature : b.features) {
    const auto own = std::ranges::find(a.features, feature.name, &FeatureSpec::name);
    if (own == a.features.end())
      a.features.push_back(feature);
    else if (own->unit != feature.unit || own->scale != feature.scale)
      refuse(a.name, fmt::format("unit or scale of feature {}, '{}' and '{}'", feature.name, own->unit,
                                 feature.unit));
  }
  for (const AttributeSpec& attribute : b.attributes) {
    const auto own = std::ranges::find(a.attributes, attribute.name, &AttributeSpec::name);
    if (own == a.attributes.end())
      a.attributes.push_back(attribute);
    else if (own->unit != attribute.unit || own->kind != attribute.kind)
      refuse(a.name, fmt::format("unit or kind of attribute {}", attribute.name));
  }
  const auto taken = [&](const std::string& name) {
    return std::ranges::find(a.attributes, name, &AttributeSpec::name) != a.attributes.end();
  };
  for (const FeatureSpec& feature : a.features)
    if (taken(feature.name))
      refuse(a.name, feature.name + " is a feature in one and an attribute in the other");
  return a;
}

template <class Set, class Specs>
Set reordered(const Set& values, const Specs& from, const Specs& to) {
  Set moved(to.size());
  for (std::size_t i = 0; i < std::min(values.size(), from.size()); ++i) {
    const auto there = std::ranges::find(to, from[i].name, [](const auto& spec) { return spec.name; });
    moved[static_cast<std::size_t>(there - to.begin())] = values[i];
  }
  return moved;
}

}  // namespace

TypeRegistry merge_types(const TypeRegistry& a, const TypeRegistry& b) {
  TypeRegistry merged;
  for (const LandmarkType& type : a) {
    const LandmarkType* other = b.find(type.name);
    merged.add(other == nullptr ? type : merge_type(type, *other));
  }
  for (const LandmarkType& type : b)
    if (a.find(type.name) == nullptr) merged.add(type);
  return merged;
}

void adopt_types(LoadedMap& map, const TypeRegistry& types) {
  for (Landmark& landmark : map.landmarks) {
    const LandmarkType& from = map.types[landmark.type];
    const LandmarkType& to = *types.find(from.name);
    landmark.features = reordered(landmark.features, from.features, to.features);
    landmark.quality.feature_confidences =
        reordered(landmark.quality.feature_confidences, from.features, to.features);
    landmark.attributes = reordered(landmark.attributes, from.attributes, to.attributes);
    landmark.type = types.id(from.name);
  }
  for (Observation& seen : map.evidence) {
    const LandmarkType& from = map.types[seen.type];
    seen.features = reordered(seen.features, from.features, types.find(from.name)->features);
    seen.type = types.id(from.name);
  }
  map.types = types;
}

}  // namespace waymark::workflows
