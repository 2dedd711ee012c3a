// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/forest/forest_presets.hpp"
namespace waymark {

/// How the trees of a canopy model are sought.
struct TreeSearch {
  ForestPreset forest = forest_preset(ForestType::mixed);
  /// Rules of treetops where a raster tells the forest type: conifer, broadleaf, mixed; empty: everywhere
  /// those of `forest`.
  std::vector<TreetopRules> by_type = {};
  bool crowns = true;
};

/// A tree seen from above.
struct FoundTree {
  CanopyCell top;
  double height = 0;                          ///< metres: the highest of the unsmoothed cells at the top
  Crown crown;                                ///< empty where crowns were not asked for
  double crown_area = 0, crown_diameter = 0;  ///< m2, and metres of the circle of that area
  double confidence = 1;                      ///< that it is a tree of its own: tree_confidence.hpp
};

/// The trees whose tops are among the cells `owned` of a survey, in row order: smoothing, treetops, crowns.
/// Reads search_halo() cells around; what is found does not depend on `owned`, but for being in it.
std::vector<FoundTree> find_trees(const CanopySource& canopy, const Window& owned, const TreeSearch& search);

/// Cells beyond `owned` that find_trees reads, for the smaller side of a cell in metres.
std::int64_t search_halo(const TreeSearch& search, double cell);

}  // namespace waymark
