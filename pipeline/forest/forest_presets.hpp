// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/forest/crowns.hpp"
#include "pipeline/forest/treetops.hpp"
namespace waymark::pipeline {

/// Parameters of tree detection for one forest type.
struct ForestPreset {
  std::string name;
  double smoothing = 0.3;  ///< sigma, metres
  TreetopRules tops;
  CrownRules crowns;
};

/// Presets conifer, broadleaf, mixed. Chosen on synthetic forests (docs/methods/trees.md), never on the
/// evaluated plots.
const ForestPreset& forest_preset(ForestType type);

/// Throws Error{usage} with the nearest name if there is no such preset.
const ForestPreset& forest_preset(std::string_view name);

/// Returns conifer, broadleaf, mixed.
std::vector<std::string> forest_preset_names();

/// Returns the reference method of the literature, variable-window local maxima (Popescu & Wynne 2004): no
/// smoothing, no prominence, window width from tree height and forest type.
ForestPreset local_maxima_preset(const ForestPreset& preset);

}  // namespace waymark::pipeline
