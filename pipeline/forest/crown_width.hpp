// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/forest/canopy_window.hpp"
#include "pipeline/forest/crown_evidence.hpp"
namespace waymark::pipeline {

inline constexpr double kMaxCrownDiameter = 14;  ///< metres

/// Returns the diameter of the crown centred at `top`, metres, [2 cells, kMaxCrownDiameter]. Rings are
/// followed outwards until dark green (vegetation index times darkness squared, ring mean) falls below half
/// of its central value. `image` covers kMaxCrownDiameter / 2 around. For touching crowns the result is the
/// width of the group.
double crown_width(const ColourWindow& image, const CanopyCell& top);

}  // namespace waymark::pipeline
