// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/rock_height.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {

std::optional<MeasuredValue> height_from_shadow(const MeasuredValue& reach_px, const ImageView& image,
                                                const GroundPlane& ground, const Sun& sun, double slope_sd,
                                                double slope_response) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  const double level = light.head<2>().norm();
  if (!(light.z() > 0) || !(level > 1e-6)) return std::nullopt;
  const Eigen::Vector2d away = -light.head<2>() / level;
  const double rise = ground.gradient.dot(away);
  if (!(light.z() / level + rise > 0.02)) return std::nullopt;
  const double per_metre = light.z() / level + slope_response * rise;  // height per level metre of shadow

  const Eigen::Vector3d step(away.x(), away.y(), rise);
  const auto from = project_to_image(image, {ground.at - 0.5 * step}),
             to = project_to_image(image, {ground.at + 0.5 * step});
  if (!from || !to) return std::nullopt;
  const double pixels_per_metre = (*to - *from).norm();
  if (!(pixels_per_metre > 0)) return std::nullopt;

  const double length = reach_px.value / pixels_per_metre, length_sd = reach_px.sd / pixels_per_metre;
  const double cosine2 = level * level;  // of the elevation
  const double from_sun = length / cosine2 * to_radians(sun.sd).value;
  return MeasuredValue{
      length * per_metre,
      std::hypot(per_metre * length_sd, std::hypot(from_sun, length * slope_response * slope_sd))};
}

double log_shadow_shortening(const GroundPlane& ground, const Sun& sun) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  const double level = light.head<2>().norm();
  if (!(light.z() > 0) || !(level > 1e-6)) return 0;
  const double rise = -ground.gradient.dot(light.head<2>()) / level;
  return std::log(std::clamp(1 + rise * level / light.z(), 0.5, 2.0));
}

}  // namespace waymark::pipeline
