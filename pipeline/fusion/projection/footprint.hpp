// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Corner of a lattice cell: cell (c, r) has corners c..c+1, r..r+1.
struct LatticeCorner {
  std::int64_t column = 0, row = 0;
  friend bool operator==(const LatticeCorner&, const LatticeCorner&) = default;
};

/// Returns outlines of the marked cells as closed rings, clockwise with rows running down.
/// Cells that touch only at a corner are separate parts. Parts with holes are cut in two until none has any.
std::vector<std::vector<LatticeCorner>> lattice_rings(const Grid<std::uint8_t>& marked);

/// Ground shown by an image.
struct Footprint {
  std::vector<ImageView::Ring> rings;  ///< one per part, closed, without holes, metres in the grid frame
  double area = 0;                     ///< square metres, horizontal projection
  double gsd = 0;                      ///< median ground sample distance, metres; 0 if no ground is visible
};

/// Computes the footprint by casting rays through a lattice of `cells` x `cells` pieces of the image.
/// - A piece counts if its four corners hit ground and the ground between them is continuous, so occluded
///   ground is excluded.
/// - Borders are as fine as the pieces; outer borders are exact. Pieces do not overlap on the ground, so
///   their outline is the footprint.
/// - A part with a hole is cut in two along a column of the lattice.
Footprint footprint(const ImageView& image, const Terrain& terrain, int cells = 48);

/// Returns whether the point lies in the ring (closed or not), by the even-odd rule.
bool inside(const ImageView::Ring& ring, const Eigen::Vector2d& point);

}  // namespace waymark::pipeline
