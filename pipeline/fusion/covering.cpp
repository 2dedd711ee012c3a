// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/covering.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/fusion/sight.hpp"

namespace waymark {
namespace {

bool hidden(const ImageView& image, const Terrain& terrain, const Visible& thing) {
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

std::optional<double> shown_at(const ImageView& image, const Terrain* terrain, const Visible& thing,
                               const CoveringRules& rules) {
  const auto middle = appears(image, {thing.at});
  if (!middle || !in_image(image, *middle)) return std::nullopt;
  // Pixels per metre east and north.
  const double step = thing.radius > 0                            ? thing.radius
                      : std::isfinite(image.gsd) && image.gsd > 0 ? image.gsd
                                                                  : 0.01;
  const auto east = appears(image, {thing.at + step * Eigen::Vector3d::UnitX()});
  const auto north = appears(image, {thing.at + step * Eigen::Vector3d::UnitY()});
  if (!east || !north) return std::nullopt;
  const Eigen::Vector2d e = (*east - *middle) / step, n = (*north - *middle) / step;
  const double pixels_per_square_metre = std::abs(e.x() * n.y() - e.y() * n.x());
  if (!(pixels_per_square_metre > 0)) return std::nullopt;
  // Half the box about the outline's image: |(J r cos t, J r sin t)| at most.
  const Eigen::Vector2d half =
      thing.radius * Eigen::Vector2d(std::hypot(e.x(), n.x()), std::hypot(e.y(), n.y()));
  for (const double sign : {-1.0, 1.0})
    if (!in_image(image, *middle + sign * half, rules.margin)) return std::nullopt;
  const double diameter = 2 * thing.radius * std::sqrt(pixels_per_square_metre);
  if (diameter < rules.least_diameter) return std::nullopt;
  if (2 * half.maxCoeff() > rules.greatest_share * static_cast<double>(std::min(image.columns, image.rows)))
    return std::nullopt;
  if (terrain && hidden(image, *terrain, thing)) return std::nullopt;
  return 1 / std::sqrt(pixels_per_square_metre);
}

}  // namespace waymark
