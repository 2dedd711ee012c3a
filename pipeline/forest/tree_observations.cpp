// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_observations.hpp"

#include <cmath>

namespace waymark::pipeline {

TreeErrors tree_errors(std::string_view forest_type, bool built_in_allometry) {
  TreeErrors errors;
  if (forest_type == "conifer") errors.height = 1.0;
  if (forest_type == "mixed") errors.height = 0.95;
  if (forest_type == "conifer" && built_in_allometry) errors.allometry = 0.2;
  return errors;
}

Observation observation_of(const DetectedTree& tree, const CanopySource& canopy, const LandmarkType& type,
                           TypeId id, std::span<const Allometry> table, std::string_view species,
                           const TreeErrors& errors) {
  const Georeference& where = canopy.geometry().where;
  const auto column = static_cast<double>(tree.top.column), row = static_cast<double>(tree.top.row);
  Observation seen;
  seen.type = id;
  seen.source = canopy.name();
  seen.pixel = Eigen::Vector2d(column, row);
  const double ground = canopy.ground_elevation(tree.top.column, tree.top.row);
  seen.position.xyz << where.x(column), where.y(row), std::isnan(ground) ? 0 : ground;
  const double unit = where.crs.metres_per_unit(), cell_x = where.dx * unit, cell_y = where.dy * unit;
  const double lean = errors.position_base + errors.position_slope * tree.height;
  seen.covariance(0, 0) = lean * lean + cell_x * cell_x / 12;
  seen.covariance(1, 1) = lean * lean + cell_y * cell_y / 12;
  seen.covariance(2, 2) = std::isnan(ground) ? std::nan("") : 0.25;
  seen.confidence = tree.confidence;
  seen.features.resize(type.features.size());
  const auto set = [&](const char* name, double value, double sd) {
    seen.features[feature_index(type, name)] = {value, sd * sd, 1};
  };
  set("height", tree.height, errors.height);
  const double crown_sd = errors.crown_relative * tree.crown_diameter;
  if (tree.crown_diameter > 0) set("crown_diameter", tree.crown_diameter, crown_sd);
  if (const Allometry* row_of = allometry_of(table, species))
    if (const auto stem = stem_diameter(*row_of, tree.height, errors.height, tree.crown_diameter, crown_sd))
      set("diameter", stem->metres, std::hypot(stem->sd, errors.allometry * stem->metres));
  return seen;
}

}  // namespace waymark::pipeline
