// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "geo/outline_shapes.hpp"
#include "importers/rules/import_rules.hpp"
#include "importers/rules/rule_expression.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::importers {

/// A rule whose names are looked up.
struct BoundRule {
  const ImportRule* rule = nullptr;
  TypeId type = 0;
  std::vector<std::optional<RuleExpression>> features, deviations;  ///< one per feature of the type
  std::vector<std::string> attributes;                              ///< tag or 'text', one per attribute
  std::optional<RuleExpression> z, position_sd, confidence;
  std::int64_t elements = 0, landmarks = 0;  ///< counts of an import
};

/// Looks up the names of a rule; `number` counts it from 1 in messages. Throws Error{usage} for an unknown
/// type, feature or attribute, and for an expression that cannot be read.
BoundRule bind_rule(const ImportRule& rule, const TypeRegistry& types, std::size_t number);

/// Returns the landmark that a rule makes of a shape of an element, without its position.
Landmark landmark_of_shape(const MapElement& element, const BoundRule& rule, const LandmarkType& type,
                           const DerivedShape& shape);

}  // namespace waymark::importers
