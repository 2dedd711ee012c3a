// SPDX-License-Identifier: Apache-2.0
#include "workflows/forest/stand_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace waymark::workflows {
namespace {

struct Share {
  double recall, sd;
};

constexpr double kHeights[] = {0, 0.6, 0.7, 0.8, 0.9};  // lower bounds, relative to dominant height

// Conifers, mixed, broadleaves of the synthetic forests, by the crowns detected in them. Neighbouring rows
// were pooled where recall did not increase with height.
struct ForestKind {
  double crown_to_height;
  Share of[std::size(kHeights)];
};
// Deviations are relative to the recall and equal for all heights, so that 90 % of the intervals of 1.645
// standard errors hold the stems of simulated forests (docs/evaluation/2026-11-22-errors-of-inventories.md).
constexpr double kConifers = 0.41, kMixed = 0.78, kBroadleaves = 0.8;
constexpr Share share(double recall, double relative) {
  return {recall, recall * relative};
}
constexpr ForestKind kKinds[] = {
    {0.194,
     {share(0.72, kConifers), share(0.72, kConifers), share(0.72, kConifers), share(0.72, kConifers),
      share(0.72, kConifers)}},
    {0.246,
     {share(0.31, kMixed), share(0.31, kMixed), share(0.42, kMixed), share(0.55, kMixed),
      share(0.67, kMixed)}},
    {0.295,
     {share(0.16, kBroadleaves), share(0.16, kBroadleaves), share(0.28, kBroadleaves),
      share(0.44, kBroadleaves), share(0.66, kBroadleaves)}}};

// Relative error that all diameters of a stand share if they were computed from heights seen from the air by
// an allometry that was not fitted there (docs/evaluation/2026-11-22-errors-of-inventories.md).
constexpr double kAllometryBias = 0.15;

/// Returns mean crown diameter over height of the tall trees of a stand, whose crowns hide others; NaN if
/// unknown.
double crown_ratio(std::span<const pipeline::StandTree> trees, std::span<const pipeline::StandCrown> crowns,
                   double dominant) {
  constexpr double kTall = 0.8;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < trees.size(); ++i)
    if (trees[i].height > kTall * dominant && crowns[i].diameter > 0)
      sum += crowns[i].diameter / trees[i].height, ++count;
  return sum / count;
}

const pipeline::Allometry& diameter_row(const StandTables& tables, const std::string& species) {
  const auto& table = tables.diameters.empty() ? pipeline::built_in_allometry() : tables.diameters;
  if (const pipeline::Allometry* row = pipeline::allometry_of(table, species)) return *row;
  throw Error(ErrorCode::input,
              fmt::format("the allometry has no row for species '{}' and none for all", species),
              tables.diameters_file, "add a row with species all");
}

const pipeline::VolumeRow& volume_row(const StandTables& tables, const std::string& species) {
  if (const pipeline::VolumeRow* row = pipeline::volume_of(tables.volumes, species)) return *row;
  throw Error(ErrorCode::input,
              fmt::format("the volume table has no row for species '{}' and none for all", species),
              tables.volumes_file, "add a row with species all");
}

}  // namespace

std::vector<pipeline::RecallRow> airborne_recall(double dominant_height, double crown_to_height) {
  if (!(dominant_height > 0) || !std::isfinite(dominant_height) || !(crown_to_height > 0)) return {};
  const bool wide = crown_to_height > kKinds[1].crown_to_height;
  const ForestKind &a = kKinds[wide], &b = kKinds[wide + 1];
  const double t =
      std::clamp((crown_to_height - a.crown_to_height) / (b.crown_to_height - a.crown_to_height), 0.0, 1.0);
  std::vector<pipeline::RecallRow> rows;
  for (std::size_t i = 0; i < std::size(kHeights); ++i)
    rows.push_back({kHeights[i] * dominant_height, std::lerp(a.of[i].recall, b.of[i].recall, t),
                    std::lerp(a.of[i].sd, b.of[i].sd, t)});
  return rows;
}

StandStems stand_stems(const MapTrees& map, const NamedStand& stand, const StandTables& tables) {
  StandStems stems;
  const pipeline::Allometry& diameters = diameter_row(tables, stand.species);
  const pipeline::VolumeRow& volumes = volume_row(tables, stand.species);
  const Eigen::AlignedBox2d box = pipeline::bounds(stand.polygon);
  for (std::size_t i = 0; i < map.trees.size(); ++i) {
    const double reach = influence_radius(map.trees[i], map.crowns[i]);
    if (box.squaredExteriorDistance(map.trees[i].position) > reach * reach) continue;
    pipeline::StandTree tree = map.trees[i];
    if (!tables.diameters.empty() || std::isnan(tree.diameter)) {
      const auto stem = pipeline::stem_diameter(diameters, tree.height, tree.height_sd,
                                                map.crowns[i].diameter, map.crowns[i].diameter_sd);
      tree.diameter = stem ? stem->metres : pipeline::StandTree::kUnknown;
      tree.diameter_sd = stem ? stem->sd : 0;
      const double bias = diameters.held_out_bias / 100;
      tree.diameter_bias = stem && !std::isnan(bias) ? std::abs(bias) : 0;
    } else if (map.from_air && !std::isnan(tree.diameter)) {
      tree.diameter_bias = kAllometryBias * tree.diameter;
    }
    tree.volume = pipeline::stem_volume(volumes, tree.diameter, tree.height);
    tree.mass = tree.volume * volumes.mass_per_volume;
    stems.near.push_back(i);
    stems.trees.push_back(tree);
  }
  return stems;
}

StandResult compute_stand_figures(const MapTrees& map, NamedStand stand, const StandTables& tables,
                                  const pipeline::InventoryOptions& options) {
  StandResult result;
  result.stand = std::move(stand);
  const pipeline::StandPolygon& polygon = result.stand.polygon;
  const auto [near, trees] = stand_stems(map, result.stand, tables);
  const bool all_near = near.size() == map.trees.size();  // their outlines are not copied
  std::vector<pipeline::StandCrown> crowns;
  for (std::size_t i = 0; !all_near && i < near.size(); ++i) crowns.push_back(map.crowns[near[i]]);
  const std::span<const pipeline::StandCrown> shades = all_near ? map.crowns : crowns;
  const pipeline::VolumeRow& volumes = volume_row(tables, result.stand.species);
  pipeline::InventoryOptions detected = options;
  detected.form_factor_error = volumes.form_factor_sd / volumes.form_factor;
  detected.recall.clear();
  result.figures = inventory(trees, polygon, detected);
  pipeline::InventoryOptions all = detected;
  all.recall = options.recall;
  if (map.from_air && all.recall.empty()) {
    const double dominant = result.figures.dominant_height.value;
    all.recall = airborne_recall(dominant, crown_ratio(trees, shades, dominant));
    all.recall_errors_correlated = true;
  }
  result.complete = all.recall.empty() ? result.figures : inventory(trees, polygon, all);
  result.cover = pipeline::canopy_cover(shades, polygon);
  return result;
}

}  // namespace waymark::workflows
