// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <span>
#include "core/landmark.hpp"
#include "core/observation.hpp"
namespace waymark::inline core {

/// Expresses positions' covariances and angles among features along other horizontal axes, such as those of
/// another CRS. `rotation` (rad, counter-clockwise) is added to an angle from the x axis. Features of scale
/// `axis` or `direction` count clockwise from map north and lose it.
void rotate_axes(Landmark& landmark, std::span<const FeatureSpec> specs, double rotation);
void rotate_axes(Observation& observation, std::span<const FeatureSpec> specs, double rotation);
void rotate_axes(FeatureSet& features, std::span<const FeatureSpec> specs, double rotation);

/// Returns whether a rotation of the axes changes the covariance or one of the features: not if the errors of
/// x and y are alike, or unknown, and no angle is known.
bool depends_on_axes(const Eigen::Matrix3d& covariance, const FeatureSet& features,
                     std::span<const FeatureSpec> specs);

/// Rotates a Landmark or an Observation as above. Calls `rotation()`, which costs transforms of coordinates,
/// only where something depends on it.
template <class Item, std::invocable Rotation>
void rotate_axes(Item& item, std::span<const FeatureSpec> specs, Rotation&& rotation) {
  if (depends_on_axes(item.covariance, item.features, specs)) rotate_axes(item, specs, rotation());
}

/// Returns a covariance of x, y and a third number along such axes. What is unknown (NaN) stays so.
Eigen::Matrix3d rotate_axes(const Eigen::Matrix3d& covariance, double rotation);

}  // namespace waymark::inline core
