// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "apps/stands_in_turn.hpp"
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/stand_inventory.hpp"
#include "pipeline/forest/stand_volume.hpp"
namespace waymark {

/// Tables for diameters and volumes.
struct StandTables {
  std::vector<Allometry>
      diameters;  ///< empty: the diameters of the map; the built-in table for trees without
  std::vector<VolumeRow> volumes = built_in_volume();
  std::string diameters_file, volumes_file;  ///< for messages
};

/// Trees of a stand, with the diameters and volumes of its species.
struct StandStems {
  std::vector<std::size_t> near;  ///< trees in or near the stand: indices of MapTrees
  std::vector<StandTree> trees;   ///< these
};

/// Throws Error{input} where a table has no row for the stand's species and none for "all".
StandStems stems_of(const MapTrees& map, const NamedStand& stand, const StandTables& tables);

struct StandResult {
  NamedStand stand;
  StandFigures figures;
  StandFigures complete;  ///< with the trees nobody found: by the recall given, else of trees from the air
  Estimate cover;
};

/// `map` holds the trees within reach of the stand, and may hold others. Throws as stems_of().
StandResult figures_of(const MapTrees& map, NamedStand stand, const StandTables& tables,
                       const InventoryOptions& options);

/// Layer `stand`: one row per stand with its figures, standard errors in columns <name>_se, and stems of each
/// diameter class. Every row has the classes of all.
ShapeLayer stand_layer(const std::vector<StandResult>& results);

/// Layer `stand_tree`: the trees of the stands, one row for each stand a tree is counted in, made as they are
/// written. Both must outlive it.
ShapeLayer tree_layer(const StandsInTurn& stands, const StandTables& tables);

}  // namespace waymark
