// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "pipeline/forest/forest_presets.hpp"
#include "workflows/training/synthetic_canopy.hpp"
namespace waymark::workflows {

/// Canopy with rougher crowns than those of the testbed, and its trees: several leaders per crown, bark and
/// twigs of 1 and 3 m, gaps, understory. Roughness varies between forests.
struct RoughForest {
  SyntheticCanopy canopy;
  Grid<std::int32_t> tree;  ///< tree whose crown covers a cell; -1: ground
};

/// Returns a hectare in cells of 0.5 or 1 m; all parameters are random.
RoughForest rough_forest(std::uint64_t seed, ForestType type);

}  // namespace waymark::workflows
