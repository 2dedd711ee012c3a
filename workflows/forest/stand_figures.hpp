// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/stand_inventory.hpp"
#include "pipeline/forest/stand_volume.hpp"
#include "workflows/forest/stand_batches.hpp"
#include "workflows/forest/stand_result.hpp"
namespace waymark::workflows {

/// Returns the recall of `waymark trees` from the air by tree height, for stands without a measured recall.
/// - Source: recalls and standard deviations between synthetic forests of 200 to 1200 stems/ha, conifers,
///   broadleaves and mixed, Poisson, clustered and planted (docs/methods/inventory.md).
/// - A tree is hidden by taller neighbours, so rows are fractions of the stand's dominant height, m.
/// - `crown_to_height` is the mean crown diameter over height of the tall trees. Recall is interpolated
///   between 0.19 and 0.30, the range of the synthetic forests, and constant outside.
/// Empty if an argument is not known.
std::vector<pipeline::RecallRow> airborne_recall(double dominant_height, double crown_to_height);

/// Tables for diameters and volumes.
struct StandTables {
  /// Empty: the diameters of the map, and the built-in table for trees without one.
  std::vector<pipeline::Allometry> diameters;
  std::vector<pipeline::VolumeRow> volumes = pipeline::built_in_volume();
  std::string diameters_file, volumes_file;  ///< for messages
};

/// Trees in or near a stand, with the diameters and volumes of its species.
struct StandStems {
  std::vector<std::size_t> near;           ///< indices of MapTrees
  std::vector<pipeline::StandTree> trees;  ///< these
};

/// Throws Error{input} if a table has no row for the stand's species and none for "all".
StandStems stand_stems(const MapTrees& map, const NamedStand& stand, const StandTables& tables);

/// `map` holds the trees near the stand and may hold others. Throws as stand_stems().
StandResult compute_stand_figures(const MapTrees& map, NamedStand stand, const StandTables& tables,
                                  const pipeline::InventoryOptions& options);

/// Returns layer `stand`: a row per stand with its figures, standard errors in columns <name>_se, and stems
/// of each diameter class. Every row has the classes of all.
geodb::ShapeLayer stand_layer(const std::vector<StandResult>& results);

/// Returns layer `stand_tree`: a row for each stand that a tree is counted in. Rows are made while they are
/// written, so both arguments must outlive the layer.
geodb::ShapeLayer tree_layer(const StandBatches& stands, const StandTables& tables);

}  // namespace waymark::workflows
