// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/stand_cover.hpp"
namespace waymark {

/// The trees of a map, metres; uids[i] names trees[i].
struct MapTrees {
  std::vector<std::string> uids;
  std::vector<StandTree> trees;
  std::vector<StandCrown> crowns;  ///< crowns[i] of trees[i]; no diameter where none is known
  double unit = 1;                 ///< metres per unit of the map's CRS
  bool from_air = false;           ///< found in a canopy model: those under others are missing
};

/// Throws Error{input} where the map has no type `tree`, or its CRS is in degrees. Crowns are the outlines of
/// layer `crown` where the map has it, else circles.
MapTrees trees_of(const MapStore& map);

/// A stand to be counted: ground in metres.
struct NamedStand {
  std::string name, species;
  StandPolygon ground;
  std::vector<ShapePart> outline;  ///< map CRS
};

/// Tables for diameters and volumes.
struct StandTables {
  std::vector<Allometry>
      diameters;  ///< empty: the diameters of the map; the built-in table for trees without
  std::vector<VolumeRow> volumes = built_in_volume();
  std::string diameters_file, volumes_file;  ///< for messages
};

struct StandResult {
  NamedStand stand;
  std::vector<std::size_t> near;     ///< trees of the map in or near the stand: indices of MapTrees
  std::vector<StandTree> trees;      ///< these, with the diameters and volumes of the stand's species
  std::vector<std::size_t> members;  ///< those counted in the stand: indices of `near` and `trees`
  StandFigures figures;
  StandFigures complete;  ///< with the trees nobody found: by the recall given, else of trees from the air
  Estimate cover;
};

/// Throws Error{input} where a table has no row for the stand's species and none for "all".
StandResult figures_of(const MapTrees& map, NamedStand stand, const StandTables& tables,
                       const InventoryOptions& options);

/// Layer `stand`: one row per stand with its figures, standard errors in columns <name>_se, and stems of each
/// diameter class. Every row has the classes of all.
ShapeLayer stand_layer(const std::vector<StandResult>& results);

/// Layer `stand_tree`: the trees of the stands, one row for each stand a tree is counted in, made as they are
/// written. Both must outlive it.
ShapeLayer tree_layer(const MapTrees& map, const std::vector<StandResult>& results);

}  // namespace waymark
