// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include "pipeline/reconstruction/surface/match_planes.hpp"
#include "pipeline/reconstruction/surface/smooth_by_planes.hpp"
namespace waymark::pipeline {

/// Numbers of refine_heights().
struct RefineRules {
  PlaneSmoothing smoothing = {};
  PlaneRules planes = {};
  double match_sd = 2;  ///< factor of the formal standard deviation: pixels of a window are not independent
  double pixel_sd = 0.12;  ///< of a parallax, pixels: what residuals do not show
};

/// Height of a cell and its standard deviation, metres; NaN: none.
struct RefinedHeight {
  float height = 0, sd = 0;
};

/// Views of the block of nodes that a cell lies in.
using ViewsAt = std::function<ComparedViews(std::int64_t column, std::int64_t row)>;

/// Cells about a window that have an effect on it.
inline constexpr std::int64_t kRefineHalo = kSmoothingHalo + 4;

/// Returns the refined cells of a window, row by row: planes matched about the smoothed heights. Cells
/// without height stay so; those without match keep theirs. Windows begin and end at blocks of `block` cells
/// or at the border of the grid; results do not depend on their division.
std::vector<RefinedHeight> refine_heights(const Grid<float>& heights, const Grid<float>& sd,
                                          const SurfaceGrid& grid, const Window& window, std::int64_t block,
                                          const ViewsAt& views, const RefineRules& rules);

}  // namespace waymark::pipeline
