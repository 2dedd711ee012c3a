// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/forest/stand_volume.hpp"
namespace waymark::pipeline {

/// Returns the recall of `waymark trees` from the air by tree height, for stands without a measured recall.
/// - Source: recalls and standard deviations between synthetic forests of 200 to 1200 stems/ha, conifers,
///   broadleaves and mixed, Poisson, clustered and planted (docs/methods/inventory.md).
/// - A tree is hidden by taller neighbours, so rows are fractions of the stand's dominant height, m.
/// - `crown_to_height` is the mean crown diameter over height of the tall trees. Recall is interpolated
/// between
///   0.19 and 0.30, the range of the synthetic forests, and constant outside.
/// Empty if an argument is not known.
std::vector<RecallRow> airborne_recall(double dominant_height, double crown_to_height);

}  // namespace waymark::pipeline
