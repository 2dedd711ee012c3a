// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/forest/crowns.hpp"
#include "pipeline/forest/treetops.hpp"
namespace waymark {

/// How trees are told in one type of forest.
struct ForestPreset {
  std::string name;
  double smoothing = 0.3;  ///< sigma, metres
  TreetopRules tops;
  CrownRules crowns;
};

/// conifer, broadleaf, mixed. Chosen on synthetic forests (docs/trees.md), never on the plots that are
/// scored.
const ForestPreset& forest_preset(ForestType type);

/// Throws Error{usage} with the nearest name where there is no such preset.
const ForestPreset& forest_preset(std::string_view name);

std::vector<std::string> forest_preset_names();

/// The reference method of the literature, variable-window local maxima (Popescu & Wynne 2004): no smoothing,
/// no prominence, the window's width by the height of the tree in its type of forest.
ForestPreset as_local_maxima(const ForestPreset& preset);

}  // namespace waymark
