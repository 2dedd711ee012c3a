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

void rotate_axes(FeatureSet& features, std::span<const FeatureSpec> specs, double rotation) {
  for (std::size_t i = 0; i < std::min(features.size(), specs.size()); ++i)
    if (features[i].known() && (specs[i].scale == Scale::axis || specs[i].scale == Scale::direction))
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
