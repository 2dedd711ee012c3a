// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>
#include "importers/tables/table_expression.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// What a column may become beside the features and attributes of a type: x, y, z (CRS units, metres), uid,
/// confidence, counts, and standard deviations or variances in metres: position_sd (east and north), x_sd,
/// y_sd, z_sd, var_x, var_y, cov_xy, var_z; `<feature>_sd` for every feature.
bool is_target(const TypeRegistry& types, const std::vector<std::string>& chosen, const std::string& name);

/// What becomes of a table's columns: target -> expression.
using ColumnBindings = std::map<std::string, TableExpression, std::less<>>;

/// Reads "x=lon,y=lat,radius=diam/2" and adds what it leaves out from the columns' names:
/// - x and y from the geometry, or from columns x/y, lon/lat, longitude/latitude, easting/northing ...;
/// - a target of the same name in any case, a unit at the end being heeded: depth_km, "Depth (km)", depth_m,
///   orientation_deg;
/// - a feature `radius` from diameter, diam or d, halved.
/// "depth=" leaves a target out. Throws Error{usage}: a target no chosen type has (with the nearest name), a
/// target twice, a column that is not there, no x and y.
ColumnBindings bind_columns(const std::string& text, const TableHeader& table, const TypeRegistry& types,
                            const std::vector<std::string>& chosen);

/// True if the names of the columns bound to x and y say longitude and latitude.
bool names_say_degrees(const ColumnBindings& bindings);

}  // namespace waymark
