// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Object whose visibility in an image is tested.
struct VisibilityTarget {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< GridFrame
  double radius = 0;                             ///< metres; 0: a point
};

struct CoverageRules {
  double margin = 1;          ///< pixels between the outline and the border of the image
  double min_diameter = 0;    ///< pixels; smaller outlines are not detectable; 0: no limit
  double max_fraction = 0.6;  ///< largest outline, as a fraction of the image's shorter side
};

/// Returns the ground sample distance at an object that the image shows completely and unoccluded, metres.
/// `std::nullopt` if the outline leaves the image, is too small or too large, or is occluded. Terrain
/// occludes its centre by more than a cell and two standard deviations. `terrain` may be null: nothing is
/// occluded then.
std::optional<double> visible_gsd(const ImageView& image, const Terrain* terrain,
                                  const VisibilityTarget& thing, const CoverageRules& rules = {});

}  // namespace waymark::pipeline
