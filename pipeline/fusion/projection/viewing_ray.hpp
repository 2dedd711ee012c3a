// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "core/frames.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Returns the line of sight of a pixel: from the camera, or vertical for an orthophoto. `std::nullopt`
/// outside the lens model.
std::optional<Ray<GridFrame>> viewing_ray(const ImageView& image, const Eigen::Vector2d& pixel);

/// Returns the pixel of a point, inside the image or not; `std::nullopt` behind the camera.
std::optional<Eigen::Vector2d> project_to_image(const ImageView& image, const Point<GridFrame>& point);

/// Returns whether the pixel lies in the image, at least `margin` pixels from the outer edge of the border
/// pixels.
bool image_contains(const ImageView& image, const Eigen::Vector2d& pixel, double margin = 0);

/// Tangent plane of the ground: height(x, y) = at.z + gradient . (x - at.x, y - at.y).
struct GroundPlane {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();        ///< GridFrame
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< rise per metre east and north

  Eigen::Vector3d normal() const { return Eigen::Vector3d(-gradient.x(), -gradient.y(), 1).normalized(); }
};

/// Returns the intersection of a ray with the upper side of the plane; `std::nullopt` if there is none ahead
/// of the origin.
std::optional<Eigen::Vector3d> intersect(const Ray<GridFrame>& ray, const GroundPlane& plane);

}  // namespace waymark::pipeline
