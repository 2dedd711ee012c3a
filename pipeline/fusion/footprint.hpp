// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geo/terrain.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// The ground an image shows.
struct Footprint {
  std::vector<ImageView::Ring> rings;  ///< one per part, closed, without holes, metres in the grid frame
  double area = 0;                     ///< square metres, seen from above
  double gsd = 0;                      ///< median ground sample distance, metres; 0 where no ground is seen
};

/// Lines of sight through a lattice of `cells` x `cells` pieces of the image; a piece counts where its four
/// corners see ground and the ground between them hangs together: behind a ridge it does not, so ground that
/// is hidden is not in the footprint. Borders are as fine as the pieces, outer borders exact. No polygons
/// are cut: pieces of an image cannot overlap on the ground, so the outline of the pieces is the footprint.
/// A part with a hole is cut in two along a column of the lattice.
Footprint footprint(const ImageView& image, const Terrain& terrain, int cells = 48);

/// Whether the point lies in the ring (closed or not), by the even-odd rule.
bool inside(const ImageView::Ring& ring, const Eigen::Vector2d& point);

}  // namespace waymark
