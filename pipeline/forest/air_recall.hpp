// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/forest/stand_volume.hpp"
namespace waymark {

/// Share of the trees that `waymark trees` finds from the air, by height, where nobody has measured it:
/// shares and standard deviations between made forests of 200 to 1200 stems/ha, conifers, broadleaves and
/// both, Poisson, clustered and planted (docs/inventory.md). Whether a tree is seen depends on how far it
/// stands below the tallest around, so rows are shares of the stand's dominant height, m; and on how wide the
/// crowns are that may hide it: `crown_share` is the mean crown diameter over height of the tall trees.
/// Between the crowns of the made forests, 0.19 to 0.30, shares are interpolated; beyond, those of the
/// nearest are taken. Empty where one of them is not known.
std::vector<RecallRow> air_recall(double dominant_height, double crown_share);

}  // namespace waymark
