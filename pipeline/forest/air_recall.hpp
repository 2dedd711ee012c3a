// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/forest/stand_volume.hpp"
namespace waymark {

/// Share of the trees that `waymark trees` finds from the air, by height, where nobody has measured it: means
/// and standard deviations between made forests of 200 to 1200 stems/ha, conifers, broadleaves and both,
/// Poisson and clustered (docs/forest_testbed.md; scripts/measure-trees repeats them). Whether a tree is seen
/// depends on how far it stands below the tallest around, so rows are shares of the stand's dominant height,
/// m. Empty where that is not known.
std::vector<RecallRow> air_recall(double dominant_height);

}  // namespace waymark
