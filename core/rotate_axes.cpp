// SPDX-License-Identifier: Apache-2.0
#include "core/rotate_axes.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::inline core {

Eigen::Matrix3d rotate_axes(const Eigen::Matrix3d& covariance, double rotation) {
  if (rotation == 0) return covariance;
  const double c = std::cos(rotation), s = std::sin(rotation);
  const Eigen::Matrix2d turn{{c, -s}, {s, c}};
  const Eigen::Matrix2d plane = covariance.topLeftCorner<2, 2>();
  const Eigen::Vector2d mixed = covariance.topRightCorner<2, 1>();
  Eigen::Matrix3d rotated = covariance;  // by blocks, so that an unknown one does not spread
  rotated.topLeftCorner<2, 2>() = turn * plane * turn.transpose();
  rotated.topRightCorner<2, 1>() = turn * mixed;
  rotated.bottomLeftCorner<1, 2>() = rotated.topRightCorner<2, 1>().transpose();
  return rotated;
}

bool depends_on_axes(const Eigen::Matrix3d& covariance, const FeatureSet& features,
                     std::span<const FeatureSpec> specs) {
  const Eigen::Matrix3d& c = covariance;
  const auto differs = [](double a, double b) { return a < b || a > b; };  // false for unknown numbers
  if (differs(c(0, 0), c(1, 1)) || differs(c(0, 1), 0) || differs(c(0, 2), 0) || differs(c(1, 2), 0))
    return true;
  for (std::size_t i = 0; i < std::min(features.size(), specs.size()); ++i)
    if (features[i].known() && is_angle(specs[i].scale)) return true;
  return false;
}

void rotate_axes(FeatureSet& features, std::span<const FeatureSpec> specs, double rotation) {
  for (std::size_t i = 0; i < std::min(features.size(), specs.size()); ++i)
    if (features[i].known() && is_angle(specs[i].scale))
      features[i].value = difference(features[i].value, rotation, specs[i].scale);
}

void rotate_axes(Landmark& landmark, std::span<const FeatureSpec> specs, double rotation) {
  if (rotation == 0) return;
  landmark.covariance = rotate_axes(landmark.covariance, rotation);
  rotate_axes(landmark.features, specs, rotation);
}

void rotate_axes(Observation& observation, std::span<const FeatureSpec> specs, double rotation) {
  if (rotation == 0) return;
  observation.covariance = rotate_axes(observation.covariance, rotation);
  rotate_axes(observation.features, specs, rotation);
}

}  // namespace waymark::inline core
