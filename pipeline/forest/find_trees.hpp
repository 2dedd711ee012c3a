// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/forest/forest_presets.hpp"
namespace waymark::pipeline {

/// Parameters of the tree search in a canopy model.
struct TreeSearch {
  ForestPreset forest = forest_preset(ForestType::mixed);
  /// Treetop rules per forest type where a raster gives the type: conifer, broadleaf, mixed. Empty:
  /// `forest` everywhere.
  std::vector<TreetopRules> by_type = {};
  bool crowns = true;
};

/// Tree detected in a canopy model.
struct DetectedTree {
  CanopyCell top;
  double height = 0;                          ///< metres: maximum of the unsmoothed cells at the top
  Crown crown;                                ///< empty if crowns are not requested
  double crown_area = 0, crown_diameter = 0;  ///< m2, and metres of the circle of that area
  double confidence = 1;                      ///< probability of being a separate tree: tree_confidence.hpp
};

/// Detects the trees whose tops are among the cells `owned`, in row order: smoothing, treetops, crowns.
/// Reads search_halo() cells around. The choice of `owned` does not affect a tree in it.
std::vector<DetectedTree> find_trees(const CanopySource& canopy, const Window& owned,
                                     const TreeSearch& search);

/// Returns the number of cells beyond `owned` that find_trees reads; `cell` is the smaller side of a cell,
/// metres.
std::int64_t search_halo(const TreeSearch& search, double cell);

}  // namespace waymark::pipeline
