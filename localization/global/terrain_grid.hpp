// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <vector>
#include "core/grid.hpp"
#include "localization/terrain_pose.hpp"
namespace waymark::localization {

/// Terrain heights on a regular grid, with a max pyramid of blocks of 2, 4, 8, ... cells. A distant ray
/// samples blocks as wide as its sector. 11 bytes per cell.
/// - Holes are filled from their margins, up to `kMaxGap` cells.
/// - Sea without data is no hole: unknown cells that reach the edge of the grid stay without terrain.
class TerrainGrid {
 public:
  /// Samples the terrain in and around a box. Each side is moved outwards by at most `beyond` metres while
  /// terrain is known there. At most `max_cells` cells on the longer side.
  TerrainGrid(const TerrainHeight& ground, Eigen::AlignedBox2d box, double beyond,
              std::int64_t max_cells = 1400);

  /// Surface at a position: bilinear height, NaN where there is none, and the distance to known terrain, m; 0
  /// if all four cells are known.
  struct Sample {
    double height = 0, gap = 0;
  };
  Sample surface(double x, double y) const {
    const double c = (x - area_.min().x()) / cell_, r = (y - area_.min().y()) / cell_;
    if (!(c >= 0 && r >= 0 && c < columns_ && r < rows_)) return {.height = std::nan("")};
    const auto c0 = static_cast<std::int64_t>(c), r0 = static_cast<std::int64_t>(r);
    const double u = c - static_cast<double>(c0), v = r - static_cast<double>(r0);
    const float *low = &heights_(c0, r0), *high = low + heights_.columns();
    const std::uint8_t *below = &gaps_(c0, r0), *above = below + gaps_.columns();
    return {.height = (1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1]),
            .gap = cell_ * std::max({below[0], below[1], above[0], above[1]})};
  }
  /// Returns the bilinear height; NaN if one of the four cells is unknown.
  double height(double x, double y) const {
    const Sample at = surface(x, y);
    return at.gap > 0 ? std::nan("") : at.height;
  }
  /// Returns the highest cell of the block of 2^level cells around a position, filled ones included; kNone if
  /// there is none.
  float highest(double x, double y, int level) const {
    const double c_of = (x - area_.min().x()) / cell_ + 0.5, r_of = (y - area_.min().y()) / cell_ + 0.5;
    if (!(c_of >= 0 && r_of >= 0)) return kNone;
    const std::int64_t c = static_cast<std::int64_t>(c_of) >> level,
                       r = static_cast<std::int64_t>(r_of) >> level;
    const Grid<float>& grid = blocks_[static_cast<std::size_t>(level)];
    return grid.contains(c, r) ? grid(c, r) : kNone;
  }
  /// Returns the distance, m, at which a ray from a position inside leaves the grid; `along` has length 1.
  double exit_distance(const Eigen::Vector2d& from, const Eigen::Vector2d& along) const {
    double distance = 1e300;
    for (int axis = 0; axis < 2; ++axis)
      if (along[axis] != 0)
        distance = std::min(distance,
                            ((along[axis] > 0 ? area_.max() : area_.min())[axis] - from[axis]) / along[axis]);
    return distance + 2 * cell_;
  }
  double cell() const { return cell_; }
  int levels() const { return static_cast<int>(blocks_.size()); }
  double summit() const { return summit_; }  ///< highest cell; kNone if none is known
  const Eigen::AlignedBox2d& area() const { return area_; }

  static constexpr float kNone = -1e30F;
  static constexpr int kMaxGap = 60;  ///< cells

 private:
  Eigen::AlignedBox2d area_;
  double cell_ = 1, columns_ = 0, rows_ = 0, summit_ = kNone;
  Grid<float> heights_;      // NaN: none; rows from south to north
  Grid<std::uint8_t> gaps_;  // cells to the nearest known one
  std::vector<Grid<float>> blocks_;
};

}  // namespace waymark::localization
