// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/camera.hpp"
#include "pipeline/rocks/shadow_shape.hpp"
namespace waymark {

/// How upright things lean in an image that looks at the ground aslant: where the top of a thing appears,
/// from its foot, per unit of its height, both in pixels of level ground. Zero at the point below the camera
/// and growing away from it, by the tangent of the angle of sight. Linear in the pixel's place: exact for a
/// pinhole that looks straight down.
struct ImageLean {
  Eigen::Vector2d at_origin = Eigen::Vector2d::Zero();
  Eigen::Matrix2d per_pixel = Eigen::Matrix2d::Zero();

  Eigen::Vector2d at(double x, double y) const { return at_origin + per_pixel * Eigen::Vector2d(x, y); }
};

/// Of a camera over level ground, fitted to 5 x 5 of its pixels. Nothing where a part of the image looks less
/// than 20 degrees down, or not at the ground.
std::optional<ImageLean> lean_of(const PosedCamera& camera);

/// What of a shadow shows between the top of a leaning thing and the tip of its shadow, against what would
/// if it stood upright: under a camera that looks with the light, rocks hide their shadows.
struct SeenShadow {
  double along = 1;  ///< seen length along the light, as a share of the whole, 0.3 to 2.5
  double aside = 0;  ///< how far the line from tip to top strays from the light, same unit, either way
  double lean = 0;   ///< of the thing, per unit of height
};
SeenShadow seen_shadow(const Eigen::Vector2d& lean, const LightFrame& light, double tan_elevation);

}  // namespace waymark
