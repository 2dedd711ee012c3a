// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/image_coverage.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/fusion/projection/viewing_ray.hpp"

namespace waymark::pipeline {
namespace {

bool is_occluded(const ImageView& image, const Terrain& terrain, const VisibilityTarget& thing) {
  if (!image.view) return false;
  const Eigen::Vector3d to = thing.at - image.view->centre().xyz;
  const double distance = to.norm();
  if (!(distance > 0)) return true;
  const RayHit hit = terrain.cast({image.view->centre(), {to / distance}});
  if (hit.end != RayEnd::ground) return false;
  const double fall = std::max(std::abs(to.z()) / distance, 0.05);
  const double cell = std::max(terrain.step_x(), terrain.step_y());
  return hit.range < distance - (cell + 2 * terrain.height_sd() + 0.2 * thing.radius) / fall;
}

}  // namespace

std::optional<double> visible_gsd(const ImageView& image, const Terrain* terrain,
                                  const VisibilityTarget& thing, const CoverageRules& rules) {
  const auto middle = project_to_image(image, {thing.at});
  if (!middle || !image_contains(image, *middle)) return std::nullopt;
  // Pixels per metre east and north.
  const double step = thing.radius > 0                            ? thing.radius
                      : std::isfinite(image.gsd) && image.gsd > 0 ? image.gsd
                                                                  : 0.01;
  const auto east = project_to_image(image, {thing.at + step * Eigen::Vector3d::UnitX()});
  const auto north = project_to_image(image, {thing.at + step * Eigen::Vector3d::UnitY()});
  if (!east || !north) return std::nullopt;
  const Eigen::Vector2d e = (*east - *middle) / step, n = (*north - *middle) / step;
  const double pixels_per_square_metre = std::abs(e.x() * n.y() - e.y() * n.x());
  if (!(pixels_per_square_metre > 0)) return std::nullopt;
  // Half the bounding box of the projected outline: max |(J r cos t, J r sin t)|.
  const Eigen::Vector2d half =
      thing.radius * Eigen::Vector2d(std::hypot(e.x(), n.x()), std::hypot(e.y(), n.y()));
  for (const double sign : {-1.0, 1.0})
    if (!image_contains(image, *middle + sign * half, rules.margin)) return std::nullopt;
  const double diameter = 2 * thing.radius * std::sqrt(pixels_per_square_metre);
  if (diameter < rules.min_diameter) return std::nullopt;
  if (2 * half.maxCoeff() > rules.max_fraction * static_cast<double>(std::min(image.columns, image.rows)))
    return std::nullopt;
  if (terrain && is_occluded(image, *terrain, thing)) return std::nullopt;
  return 1 / std::sqrt(pixels_per_square_metre);
}

}  // namespace waymark::pipeline
