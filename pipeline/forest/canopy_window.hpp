// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
namespace waymark::pipeline {

/// Cell of a canopy model, in its whole grid.
struct CanopyCell {
  std::int64_t column = 0, row = 0;
  friend bool operator==(const CanopyCell&, const CanopyCell&) = default;
};

/// Heights above ground in a window of a canopy model.
struct CanopyWindow {
  Window cells;                            ///< in the whole grid
  Grid<float> heights;                     ///< metres; kNoCanopy where unknown
  double cell_width = 1, cell_height = 1;  ///< metres

  float at(const CanopyCell& c) const { return heights(c.column - cells.column, c.row - cells.row); }
  bool contains(const CanopyCell& c) const { return cells.contains(c.column, c.row); }
};

/// Smooths with a Gaussian of `sigma` metres along rows, then columns, cut at 3 sigma. O(cells x kernel).
/// - Unknown cells have no weight and stay unknown. A sigma below 0.3 cells changes nothing.
/// - A cell depends only on cells within smoothing_reach(sigma, cell) and is bitwise the same for any window.
CanopyWindow smooth_canopy(const CanopyWindow& canopy, double sigma);

/// Returns the number of cells on either side that smoothing reads.
std::int64_t smoothing_reach(double sigma, double cell);

}  // namespace waymark::pipeline
