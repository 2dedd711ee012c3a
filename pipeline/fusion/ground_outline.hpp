// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "core/detection.hpp"
#include "pipeline/fusion/sight.hpp"
namespace waymark {

/// An ellipse on the map: centre on the ground, axes as seen from straight above.
struct GroundOutline {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< GridFrame
  double major = 0, minor = 0;                       ///< full axes, metres, major >= minor
  double orientation = 0;  ///< of the major axis, radians clockwise from north, (-pi/2, pi/2]

  double diameter() const { return std::sqrt(major * minor); }
};

/// The outline's ellipse on a plane of ground: 16 of its points are taken there, and the first harmonic of
/// the curve they form is the ellipse. Exact for an affine view; the perspective of an outline that fills a
/// tenth of the distance changes it by less than 1 %. Nothing where a line of sight misses the plane.
std::optional<GroundOutline> outline_on(const ImageView& image, const PixelEllipse& outline,
                                        const GroundPlane& plane);

/// The same ellipse as conjugate half axes a, b: the curve centre + a cos t + b sin t in the plane.
GroundOutline ellipse_of(const Eigen::Vector3d& centre, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Point of the outline at phase t: t = 0 on the major axis.
Eigen::Vector2d outline_point(const PixelEllipse& outline, double t);

}  // namespace waymark
