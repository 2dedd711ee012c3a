// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/ground_outline.hpp"

#include <cmath>
#include <numbers>

namespace waymark::pipeline {

Eigen::Vector2d outline_point(const PixelEllipse& outline, double t) {
  const double along = outline.major / 2 * std::cos(t), across = outline.minor / 2 * std::sin(t);
  const double c = std::cos(outline.angle), s = std::sin(outline.angle);
  return {outline.x + along * c - across * s, outline.y + along * s + across * c};
}

GroundOutline ellipse_from_conjugate_axes(const Eigen::Vector3d& centre, const Eigen::Vector2d& a,
                                          const Eigen::Vector2d& b) {
  // Semi-axes are the roots of the eigenvalues of a a' + b b'.
  const double xx = a.x() * a.x() + b.x() * b.x(), yy = a.y() * a.y() + b.y() * b.y();
  const double xy = a.x() * a.y() + b.x() * b.y();
  const double mean = (xx + yy) / 2, half = std::hypot((xx - yy) / 2, xy);
  GroundOutline outline;
  outline.centre = centre;
  outline.major = 2 * std::sqrt(mean + half);
  outline.minor = 2 * std::sqrt(std::max(mean - half, 0.0));
  const double from_east = std::atan2(2 * xy, xx - yy) / 2;  // anticlockwise
  double azimuth = std::numbers::pi / 2 - from_east;
  if (azimuth > std::numbers::pi / 2) azimuth -= std::numbers::pi;
  outline.orientation = azimuth;
  return outline;
}

std::optional<GroundOutline> project_outline(const ImageView& image, const PixelEllipse& outline,
                                             const GroundPlane& plane) {
  constexpr int kPoints = 16;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  for (int k = 0; k < kPoints; ++k) {
    const double t = 2 * std::numbers::pi * k / kPoints;
    const auto line = viewing_ray(image, outline_point(outline, t));
    if (!line) return std::nullopt;
    const auto point = intersect(*line, plane);
    if (!point) return std::nullopt;
    centre += *point / kPoints;
    a += point->head<2>() * (2 * std::cos(t) / kPoints);
    b += point->head<2>() * (2 * std::sin(t) / kPoints);
  }
  return ellipse_from_conjugate_axes(centre, a, b);
}

}  // namespace waymark::pipeline
