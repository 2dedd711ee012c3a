// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/surface/surface_grid.hpp"
namespace waymark::pipeline {

/// Heights known coarsely: start of the first pass, or reference of the poses.
struct CoarseHeights {
  SurfaceGrid grid = {};
  Grid<float> heights = {};  ///< NaN: unknown
  double sd = 0;             ///< metres; 0: unknown

  /// Returns the bilinear height; NaN outside, and where one of four cells is unknown.
  double at(double x, double y) const;
};

/// Returns the heights with other cells: means of 2 x 2 while the cells are half as large or smaller, so that
/// no detail is aliased, then bilinear. A mean with an unknown cell is unknown.
CoarseHeights with_cell(const CoarseHeights& dem, double cell);

}  // namespace waymark::pipeline
