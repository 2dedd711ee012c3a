// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"

#include <algorithm>
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
