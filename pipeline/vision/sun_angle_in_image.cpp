// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/sun_angle_in_image.hpp"

#include <cmath>

namespace waymark::pipeline {

std::optional<Radians> sun_angle_in_image(const ImageInfo& image) {
  if (image.image_sun_angle) return to_radians(*image.image_sun_angle);
  if (!image.sun) return {};
  Eigen::Vector3d level = sun_direction(*image.sun).unit;
  level.z() = 0;
  if (level.norm() < 0.0087) return {};
  level.normalize();
  if (image.ortho) {
    const double down = image.ortho->dy < 0 ? -level.y() : level.y();
    return Radians{std::atan2(down, level.x())};
  }
  if (!image.view) return {};
  const Eigen::Vector2d middle{double(image.columns - 1) / 2, double(image.rows - 1) / 2};
  const auto line = ray(*image.view, middle);
  if (!line || !(line->direction.unit.z() < 0)) return {};
  // The distance to the ground does not matter: the direction of a small level step is the same at any range.
  const Point<GridFrame> at{line->origin.xyz + 1000 * line->direction.unit};
  const auto from = project(*image.view, at), to = project(*image.view, Point<GridFrame>{at.xyz + level});
  if (!from || !to) return {};
  const Eigen::Vector2d step = *to - *from;
  if (!(step.norm() > 1e-9)) return {};
  return Radians{std::atan2(step.y(), step.x())};
}

}  // namespace waymark::pipeline
