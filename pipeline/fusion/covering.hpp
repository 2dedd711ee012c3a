// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// Something an image may show.
struct Visible {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< GridFrame
  double radius = 0;                             ///< metres; 0: a point
};

struct CoveringRules {
  double margin = 1;            ///< pixels between the outline and the border of the image
  double least_diameter = 0;    ///< pixels: smaller outlines cannot be seen; 0: no limit
  double greatest_share = 0.6;  ///< of the image's shorter side: larger outlines are not looked for
};

/// Ground sample distance at a thing the image shows whole and unhidden, metres; nothing where it does not:
/// the outline reaches beyond the image or is too small or too large in it, or the ground lies in front of
/// its middle (by more than a cell of the terrain and two of its standard deviations).
/// `terrain` may be null: nothing is hidden then.
std::optional<double> shown_at(const ImageView& image, const Terrain* terrain, const Visible& thing,
                               const CoveringRules& rules = {});

}  // namespace waymark
