// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
namespace waymark::exporters {

/// Heights at halving resolutions: each cell of a level is the mean of the known ones of its four cells in
/// the finer level. Cells without height (NaN) take that of the coarser level, so that relief and hillshade
/// have no cliffs there.
class HeightPyramid {
 public:
  /// Requires that at least one height is known.
  explicit HeightPyramid(Grid<float> heights);

  int levels() const { return static_cast<int>(levels_.size()); }
  const Grid<float>& level(int number) const { return levels_[static_cast<std::size_t>(number)]; }
  /// Returns the height at a position in cells of level 0, (0, 0) the corner of the first cell: bilinear
  /// between cell centres of a level, constant beyond the outermost ones.
  float at(int level, double column, double row) const;

 private:
  std::vector<Grid<float>> levels_;
};

}  // namespace waymark::exporters
