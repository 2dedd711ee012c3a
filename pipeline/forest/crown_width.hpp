// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/forest/canopy_window.hpp"
#include "pipeline/forest/crown_evidence.hpp"
namespace waymark {

inline constexpr double kWidestCrown = 14;  ///< metres

/// Diameter of the crown whose middle is at `top`, metres, [2 cells, kWidestCrown]: rings are followed
/// outwards until dark green (vegetation index times darkness squared, averaged over the ring) falls below
/// half of what it is in the middle. `image` reaches kWidestCrown / 2 around. Crowns that touch are one dark
/// green, so there it is the width of the group that is told.
double crown_width(const ColourWindow& image, const CanopyCell& top);

}  // namespace waymark
