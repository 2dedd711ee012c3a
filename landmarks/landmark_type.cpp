// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/error.hpp"
#include "landmarks/colour.hpp"

namespace waymark::inline landmarks {
namespace {

bool is_column_name(std::string_view name) {
  return !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

constexpr std::array<std::string_view, 5> kEvidenceModels = {"none", "shadow_caster", "bowl", "canopy",
                                                             "upright"};

bool is_positive(double value) {
  return std::isfinite(value) && value > 0;
}

template <class Predicate>
std::optional<TypeId> first_type(const TypeRegistry& types, Predicate predicate) {
  const auto found = std::ranges::find_if(types, predicate);
  if (found == types.end()) return std::nullopt;
  return static_cast<TypeId>(found - types.begin());
}

}  // namespace

TypeId TypeRegistry::add(LandmarkType type) {
  if (!is_column_name(type.name))
    throw std::logic_error("'" + type.name + "' is not a valid name for a landmark type");
  if (find(type.name)) throw std::logic_error("two landmark types named " + type.name);
  if (!is_colour(type.colour)) throw std::logic_error(type.name + ": its colour is not #rrggbb");
  std::set<std::string> columns;
  for (const auto& feature : type.features)
    if (!is_column_name(feature.name) || !columns.insert(feature.name).second)
      throw std::logic_error(type.name + ": bad or repeated feature '" + feature.name + "'");
  for (const auto& attribute : type.attributes)
    if (!is_column_name(attribute.name) || !columns.insert(attribute.name).second)
      throw std::logic_error(type.name + ": bad or repeated attribute '" + attribute.name + "'");
  if (!type.body.feature.empty() &&
      std::ranges::find(type.features, type.body.feature, &FeatureSpec::name) == type.features.end())
    throw std::logic_error(type.name + ": its body is measured by '" + type.body.feature +
                           "', which is no feature of it");
  if (!is_positive(type.body.radius_per_value) || !is_positive(type.identification_reach))
    throw std::logic_error(type.name + ": radius_per_value and identification_reach must be above 0");
  types_.push_back(std::move(type));
  return static_cast<TypeId>(types_.size() - 1);
}

const LandmarkType* TypeRegistry::find(std::string_view name) const {
  const auto found = std::ranges::find(types_, name, &LandmarkType::name);
  return found == types_.end() ? nullptr : &*found;
}

TypeId TypeRegistry::id(std::string_view name) const {
  const auto found = std::ranges::find(types_, name, &LandmarkType::name);
  if (found != types_.end()) return static_cast<TypeId>(found - types_.begin());
  const std::string nearest = nearest_name(name, names());
  throw Error(ErrorCode::usage, "there is no landmark type '" + std::string(name) + "'", "",
              nearest.empty() ? "`waymark types` lists them" : "did you mean '" + nearest + "'?");
}

std::vector<std::string> TypeRegistry::names() const {
  std::vector<std::string> all;
  for (const auto& type : types_) all.push_back(type.name);
  return all;
}

std::optional<TypeId> find_type(const TypeRegistry& types, EvidenceModel evidence) {
  return first_type(types, [&](const LandmarkType& type) { return type.evidence == evidence; });
}

std::optional<TypeId> find_self_identifying_type(const TypeRegistry& types) {
  return first_type(types, [](const LandmarkType& type) { return type.identifies_itself; });
}

std::string_view to_string(EvidenceModel evidence) {
  return kEvidenceModels.at(static_cast<std::size_t>(evidence));
}

std::string_view to_string(Solid solid) {
  constexpr std::array<std::string_view, 5> kNames{"point", "sphere", "cylinder", "cone", "bowl"};
  return kNames.at(static_cast<std::size_t>(solid));
}

EvidenceModel parse_evidence_model(std::string_view name) {
  const auto found = std::ranges::find(kEvidenceModels, name);
  if (found == kEvidenceModels.end())
    throw std::logic_error("there is no evidence model '" + std::string(name) + "'");
  return static_cast<EvidenceModel>(found - kEvidenceModels.begin());
}

std::size_t feature_index(const LandmarkType& type, std::string_view feature) {
  const auto found = std::ranges::find(type.features, feature, &FeatureSpec::name);
  if (found == type.features.end())
    throw std::logic_error(type.name + " has no feature '" + std::string(feature) + "'");
  return static_cast<std::size_t>(found - type.features.begin());
}

std::size_t attribute_index(const LandmarkType& type, std::string_view attribute) {
  const auto found = std::ranges::find(type.attributes, attribute, &AttributeSpec::name);
  if (found == type.attributes.end())
    throw std::logic_error(type.name + " has no attribute '" + std::string(attribute) + "'");
  return static_cast<std::size_t>(found - type.attributes.begin());
}

}  // namespace waymark::inline landmarks
