// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "core/frames.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// The line a pixel sees along: from the camera, or straight down on an orthophoto. Nothing where the lens
/// model has no answer.
std::optional<Ray<GridFrame>> sight(const ImageView& image, const Eigen::Vector2d& pixel);

/// Where a point of the ground appears, inside the image or not; nothing behind the camera.
std::optional<Eigen::Vector2d> appears(const ImageView& image, const Point<GridFrame>& point);

/// Whether the pixel lies in the image, at least `margin` pixels from its border (the outer edges of the
/// outermost pixels).
bool in_image(const ImageView& image, const Eigen::Vector2d& pixel, double margin = 0);

/// Ground about a point taken as a plane: height(x, y) = at.z + gradient . (x - at.x, y - at.y).
struct GroundPlane {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();        ///< GridFrame
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< rise per metre east and north

  Eigen::Vector3d normal() const { return Eigen::Vector3d(-gradient.x(), -gradient.y(), 1).normalized(); }
};

/// Where the ray meets the plane ahead of its origin, seen from above; nothing where it does not.
std::optional<Eigen::Vector3d> meet(const Ray<GridFrame>& ray, const GroundPlane& plane);

}  // namespace waymark
