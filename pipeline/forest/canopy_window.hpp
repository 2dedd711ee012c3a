// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
namespace waymark {

/// A cell of a canopy model, in its whole grid.
struct CanopyCell {
  std::int64_t column = 0, row = 0;
  friend bool operator==(const CanopyCell&, const CanopyCell&) = default;
};

/// Heights above ground in a window of a canopy model.
struct CanopyWindow {
  Window cells;                            ///< of the whole grid
  Grid<float> heights;                     ///< metres; kNoCanopy where unknown
  double cell_width = 1, cell_height = 1;  ///< metres

  float at(const CanopyCell& c) const { return heights(c.column - cells.column, c.row - cells.row); }
  bool contains(const CanopyCell& c) const { return cells.contains(c.column, c.row); }
};

/// Gaussian smoothing with `sigma` metres along rows, then columns, cut at 3 sigma; unknown cells count for
/// nothing and stay unknown. A sigma below 0.3 cells changes nothing. A cell depends on those within
/// smoothing_reach(sigma, cell) alone and is bitwise the same whatever the window around them is.
/// O(cells x kernel).
CanopyWindow smoothed(const CanopyWindow& canopy, double sigma);

/// Cells that smoothing looks at on either side.
std::int64_t smoothing_reach(double sigma, double cell);

}  // namespace waymark
