// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/viewing_ray.hpp"

#include <Eigen/Geometry>

namespace waymark::pipeline {
namespace {

constexpr double kAboveAll = 1e5;  // metres: above the ground of any body

}  // namespace

std::optional<Ray<GridFrame>> viewing_ray(const ImageView& image, const Eigen::Vector2d& pixel) {
  if (image.view) return ray(*image.view, pixel);
  if (!image.ortho) return std::nullopt;
  const OrthoGrid& o = *image.ortho;
  return Ray<GridFrame>{{{o.x0 + pixel.x() * o.step_x, o.y0 + pixel.y() * o.step_y, kAboveAll}},
                        {-Eigen::Vector3d::UnitZ()}};
}

std::optional<Eigen::Vector2d> project_to_image(const ImageView& image, const Point<GridFrame>& point) {
  if (image.view) return project(*image.view, point);
  if (!image.ortho) return std::nullopt;
  const OrthoGrid& o = *image.ortho;
  return Eigen::Vector2d((point.xyz.x() - o.x0) / o.step_x, (point.xyz.y() - o.y0) / o.step_y);
}

bool image_contains(const ImageView& image, const Eigen::Vector2d& pixel, double margin) {
  const auto columns = static_cast<double>(image.columns), rows = static_cast<double>(image.rows);
  return pixel.x() >= margin - 0.5 && pixel.y() >= margin - 0.5 && pixel.x() <= columns - 0.5 - margin &&
         pixel.y() <= rows - 0.5 - margin;
}

std::optional<Eigen::Vector3d> intersect(const Ray<GridFrame>& ray, const GroundPlane& plane) {
  const Eigen::Vector3d normal = plane.normal();
  const double falls = normal.dot(ray.direction.unit);
  if (!(falls < -1e-6)) return std::nullopt;
  const double range = normal.dot(plane.at - ray.origin.xyz) / falls;
  if (!(range > 0)) return std::nullopt;
  return ray.origin.xyz + range * ray.direction.unit;
}

}  // namespace waymark::pipeline
