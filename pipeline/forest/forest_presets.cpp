// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/forest_presets.hpp"

#include <algorithm>
#include <array>

#include "core/error.hpp"

namespace waymark::pipeline {
namespace {

const std::array<ForestPreset, 3>& presets() {
  static const std::array<ForestPreset, 3> all{{
      {.name = "conifer",
       .smoothing = 0.25,
       .tops = {.min_height = 3, .isolation_base = 0.6, .isolation_slope = 0.03, .prominence = 0.2},
       .crowns = {.min_height_fraction = 0.3, .radius_base = 2, .radius_slope = 0.2, .max_radius = 10}},
      {.name = "broadleaf",
       .smoothing = 0.35,
       .tops = {.min_height = 3, .isolation_base = 0.8, .isolation_slope = 0.04, .prominence = 0.3},
       .crowns = {.min_height_fraction = 0.3, .radius_base = 4, .radius_slope = 0.4, .max_radius = 14}},
      {.name = "mixed",
       .smoothing = 0.3,
       .tops = {.min_height = 3, .isolation_base = 0.7, .isolation_slope = 0.035, .prominence = 0.25},
       .crowns = {.min_height_fraction = 0.3, .radius_base = 3, .radius_slope = 0.3, .max_radius = 12}},
  }};
  return all;
}

}  // namespace

const ForestPreset& forest_preset(ForestType type) {
  switch (type) {
    case ForestType::conifer:
      return presets()[0];
    case ForestType::broadleaf:
      return presets()[1];
    default:
      return presets()[2];
  }
}

const ForestPreset& forest_preset(std::string_view name) {
  const auto found = std::ranges::find(presets(), name, &ForestPreset::name);
  if (found != presets().end()) return *found;
  const std::string nearest = nearest_name(name, forest_preset_names());
  throw Error(ErrorCode::usage, "there is no preset '" + std::string(name) + "'", "",
              nearest.empty() ? "choose conifer, broadleaf or mixed" : "did you mean '" + nearest + "'?");
}

std::vector<std::string> forest_preset_names() {
  std::vector<std::string> names;
  for (const ForestPreset& preset : presets()) names.push_back(preset.name);
  return names;
}

ForestPreset local_maxima_preset(const ForestPreset& preset) {
  ForestPreset reference = preset;
  reference.smoothing = 0;
  reference.tops.prominence = 0;
  // Half of the crown widths 3.75 - 0.18 h + 0.0124 h2 (conifers) and 3.10 + 0.0090 h2 (deciduous), 2.52 +
  // 0.0090 h2 (both), as lines through their values at 10 and 30 m.
  if (preset.name == "conifer") reference.tops.isolation_base = 0, reference.tops.isolation_slope = 0.16;
  if (preset.name == "broadleaf") reference.tops.isolation_base = 0.2, reference.tops.isolation_slope = 0.18;
  if (preset.name == "mixed") reference.tops.isolation_base = 0, reference.tops.isolation_slope = 0.177;
  return reference;
}

}  // namespace waymark::pipeline
