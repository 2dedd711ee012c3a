// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>
#include "geo/outline_shapes.hpp"
#include "importers/rules/map_element.hpp"
namespace waymark::importers {

/// What a tag of an element must be.
struct TagCondition {
  std::string tag;
  std::vector<std::string> any_of;  ///< "*": any value; empty: the element must not have the tag
};

/// One rule: elements that become landmarks of one type.
struct ImportRule {
  std::string type;
  std::vector<std::string> layers;   ///< empty: all
  std::vector<TagCondition> where;   ///< all must hold
  std::vector<TagCondition> except;  ///< none may hold
  bool of_outlines = false;          ///< only elements with outlines or closed lines, which are outlines then
  ShapeOptions shape;
  std::map<std::string, std::string> features;    ///< feature, z or <feature>_sd -> expression of tags
  std::map<std::string, std::string> attributes;  ///< attribute -> tag, or 'text'
  std::string uid;                                ///< tag; empty: made of the position
  std::string position_sd;                        ///< expression, m; empty: unknown
  std::string confidence;                         ///< expression; empty: 1

  bool matches(const MapElement& element) const;
  /// Returns the element as the rule takes it: with `of_outlines`, closed lines as outlines and no others.
  MapElement taken(const MapElement& element) const;
  /// Returns "pole (highway = street_lamp)".
  std::string title() const;
};

struct ImportRules {
  std::string crs, map_crs, layer, unit;  ///< as the options of `waymark import`; empty: not stated
  std::vector<ImportRule> rules;
};

/// Reads a rules file (docs/reference/import_rules.md), or ready rules by their name. Throws Error{input}
/// with the JSON path for members that are unknown or of a wrong kind, Error{usage} for an unknown name.
ImportRules read_import_rules(const std::string& file_or_name);

/// Returns the text of a rules file or of ready rules.
std::string import_rules_text(const std::string& file_or_name);

}  // namespace waymark::importers
