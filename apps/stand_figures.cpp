// SPDX-License-Identifier: Apache-2.0
#include "apps/stand_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "pipeline/forest/air_recall.hpp"

namespace waymark {
namespace {

/// Mean crown diameter over height of the trees that are tall in their stand: those whose crowns hide others.
/// NaN where none is known.
double crown_share(std::span<const StandTree> trees, std::span<const StandCrown> crowns, double dominant) {
  constexpr double kTall = 0.8;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < trees.size(); ++i)
    if (trees[i].height > kTall * dominant && crowns[i].diameter > 0)
      sum += crowns[i].diameter / trees[i].height, ++count;
  return sum / count;
}

const Allometry& diameters_for(const StandTables& tables, const std::string& species) {
  const auto& table = tables.diameters.empty() ? built_in_allometry() : tables.diameters;
  if (const Allometry* row = allometry_of(table, species)) return *row;
  throw Error(ErrorCode::input,
              fmt::format("the allometry has no row for species '{}' and none for all", species),
              tables.diameters_file, "add a row with species all");
}

const VolumeRow& volumes_for(const StandTables& tables, const std::string& species) {
  if (const VolumeRow* row = volume_of(tables.volumes, species)) return *row;
  throw Error(ErrorCode::input,
              fmt::format("the volume table has no row for species '{}' and none for all", species),
              tables.volumes_file, "add a row with species all");
}

}  // namespace

StandStems stems_of(const MapTrees& map, const NamedStand& stand, const StandTables& tables) {
  StandStems stems;
  const Allometry& diameters = diameters_for(tables, stand.species);
  const VolumeRow& volumes = volumes_for(tables, stand.species);
  const Eigen::AlignedBox2d box = bounds(stand.ground);
  for (std::size_t i = 0; i < map.trees.size(); ++i) {
    const double reach = reach_of(map.trees[i], map.crowns[i]);
    if (box.squaredExteriorDistance(map.trees[i].place) > reach * reach) continue;
    StandTree tree = map.trees[i];
    if (!tables.diameters.empty() || std::isnan(tree.diameter)) {
      const auto stem = stem_diameter(diameters, tree.height, tree.height_sd, map.crowns[i].diameter,
                                      map.crowns[i].diameter_sd);
      tree.diameter = stem ? stem->metres : StandTree::kUnknown;
      tree.diameter_sd = stem ? stem->sd : 0;
      const double bias = diameters.held_out_bias / 100;
      tree.diameter_bias = stem && !std::isnan(bias) ? std::abs(bias) : 0;
    }
    tree.volume = stem_volume(volumes, tree.diameter, tree.height);
    tree.mass = tree.volume * volumes.mass_per_volume;
    stems.near.push_back(i);
    stems.trees.push_back(tree);
  }
  return stems;
}

StandResult figures_of(const MapTrees& map, NamedStand stand, const StandTables& tables,
                       const InventoryOptions& options) {
  StandResult result;
  result.stand = std::move(stand);
  const StandPolygon& ground = result.stand.ground;
  const auto [near, trees] = stems_of(map, result.stand, tables);
  const bool all_near = near.size() == map.trees.size();  // their outlines are not copied
  std::vector<StandCrown> crowns;
  for (std::size_t i = 0; !all_near && i < near.size(); ++i) crowns.push_back(map.crowns[near[i]]);
  const std::span<const StandCrown> shades = all_near ? map.crowns : crowns;
  const VolumeRow& volumes = volumes_for(tables, result.stand.species);
  InventoryOptions all = options;
  all.form_factor_error = volumes.form_factor_sd / volumes.form_factor;
  result.figures = result.complete = inventory(trees, ground, all);
  if (map.from_air && all.recall.empty()) {
    const double dominant = result.figures.dominant_height.value;
    all.recall = air_recall(dominant, crown_share(trees, shades, dominant));
    all.recall_errs_alike = true;
    result.complete = inventory(trees, ground, all);
  }
  result.cover = cover(shades, ground);
  return result;
}

}  // namespace waymark
