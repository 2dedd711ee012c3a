// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "core/detection.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"
namespace waymark::pipeline {

/// Ellipse on the ground; axes in horizontal projection.
struct GroundOutline {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< GridFrame
  double major = 0, minor = 0;                       ///< full axes, metres, major >= minor
  double orientation = 0;  ///< of the major axis, radians clockwise from north, (-pi/2, pi/2]

  double diameter() const { return std::sqrt(major * minor); }
};

/// Projects an outline onto a ground plane; the ellipse is the first harmonic of 16 projected points.
/// Exact for an affine view; for an outline as wide as a tenth of the distance better than 1 %.
/// `std::nullopt` if a line of sight misses the plane.
std::optional<GroundOutline> project_outline(const ImageView& image, const PixelEllipse& outline,
                                             const GroundPlane& plane);

/// Returns the ellipse of conjugate semi-axes a and b: the curve centre + a cos t + b sin t.
GroundOutline ellipse_from_conjugate_axes(const Eigen::Vector3d& centre, const Eigen::Vector2d& a,
                                          const Eigen::Vector2d& b);

/// Returns the point of the outline at phase t; t = 0 on the major axis.
Eigen::Vector2d outline_point(const PixelEllipse& outline, double t);

}  // namespace waymark::pipeline
