// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/camera.hpp"
namespace waymark::pipeline {

struct LightFrame;

/// Relief displacement in an oblique image: shift of the top of an upright object from its foot, per unit
/// of height, both in pixels of level ground. Zero at the nadir point, growing away from it with the
/// tangent of the off-nadir angle. Linear in pixel position: exact for a nadir-looking pinhole.
struct ReliefDisplacement {
  Eigen::Vector2d at_origin = Eigen::Vector2d::Zero();
  Eigen::Matrix2d per_pixel = Eigen::Matrix2d::Zero();

  Eigen::Vector2d at(double x, double y) const { return at_origin + per_pixel * Eigen::Vector2d(x, y); }
};

/// Fits the relief displacement of a camera over level ground to 5 x 5 of its pixels. `std::nullopt` if a
/// part of the image looks less than 20 degrees down or misses the ground.
std::optional<ReliefDisplacement> relief_displacement_of(const PosedCamera& camera);

/// Visible part of a shadow, between the displaced top of an object and the tip of its shadow, compared
/// with a vertical view. A camera that looks along the light hides shadows behind the rocks.
struct VisibleShadow {
  double along = 1;         ///< visible length along the light, as a fraction of the whole, 0.3 to 2.5
  double deviation = 0;     ///< deviation of the line from tip to top from the light, same unit, absolute
  double displacement = 0;  ///< displacement per unit of height
};
/// Computes the visible part for a displacement per unit of height, and the tangent of the sun's elevation.
VisibleShadow visible_shadow(const Eigen::Vector2d& displacement, const LightFrame& light,
                             double tan_elevation);

}  // namespace waymark::pipeline
