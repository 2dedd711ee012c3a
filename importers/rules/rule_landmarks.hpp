// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "core/landmark.hpp"
#include "importers/rules/import_rules.hpp"
#include "importers/tables/table_landmarks.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::importers {

/// Makes landmarks of the elements of a file by rules, and passes them to `take` in the order of elements.
/// - Of the rules of one type the first that matches an element is used.
/// - A row is a shape: a point, a corner, a piece of a wall. Rows are rejected, and counted, as by
///   import_table(), and if the geometry does not fit the rule (no outline, a wall of zero length, a corner
///   shared with a neighbouring building).
/// - Elements without a matching rule are no rows; `bindings` has the count of each rule.
/// - Lengths and directions are measured in a plane tangent to the body at each element. Directions are found
///   from true north and turned to that of the map. Local coordinates have the unit of the rules, else that
///   of the file, else metres.
/// - Rules that use the outside of outlines, corners or ends read the file twice. 40 bytes per vertex of
///   outlines and 130 of lines are then kept in memory.
/// `table_crs`, `map_crs` and `aoi` are those of TableImport. Throws Error{usage} for rules with an unknown
/// type, feature or attribute, Error{input} if no element matches or no landmark results.
ImportedTable import_by_rules(ElementSource& source, const std::string& path, const TypeRegistry& types,
                              const ImportRules& rules, const std::string& table_crs,
                              const std::string& map_crs, const std::function<void(Landmark&&)>& take,
                              const std::string& aoi = {});

}  // namespace waymark::importers
