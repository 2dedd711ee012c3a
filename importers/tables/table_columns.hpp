// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>
#include "importers/tables/table_expression.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::importers {

/// Returns whether a column can be bound to `name`: a feature or attribute of the types, x, y, z (CRS units,
/// metres), uid, confidence, counts; standard deviations or variances in metres: position_sd (east and
/// north), x_sd, y_sd, z_sd, var_x, var_y, cov_xy, var_z; `<feature>_sd` of every feature.
bool is_target(const TypeRegistry& types, const std::vector<std::string>& chosen, const std::string& name);

struct ColumnAssignment {
  std::string target, expression;
};

/// Splits "t=stamp,v=speed/3.6" at commas outside quotes and parentheses. Throws Error{usage} for a part
/// without a target.
std::vector<ColumnAssignment> column_assignments(const std::string& text);

/// Expressions for the properties of a landmark: target -> expression.
using ColumnBindings = std::map<std::string, TableExpression, std::less<>>;

/// Parses "x=lon,y=lat,radius=diam/2" and infers missing bindings from the columns' names:
/// - x and y from the geometry, or from columns x/y, lon/lat, longitude/latitude, easting/northing ...;
/// - a target of the same name in any case, with an optional unit at the end: depth_km, "Depth (km)",
///   depth_m, orientation_deg;
/// - a feature `radius` from diameter, diam or d, halved.
/// "depth=" omits a target. Throws Error{usage} for a target that no chosen type has (with the nearest name),
/// a duplicate target, a missing column, and if x and y are missing.
ColumnBindings bind_columns(const std::string& text, const TableHeader& table, const TypeRegistry& types,
                            const std::vector<std::string>& chosen);

/// Returns true if the columns bound to x and y are named longitude and latitude.
bool names_imply_degrees(const ColumnBindings& bindings);

}  // namespace waymark::importers
