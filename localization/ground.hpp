// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include "localization/pose2.hpp"
namespace waymark {

/// Height of the ground at a place of the map frame, metres above the datum; nothing where it is not known.
using GroundHeight = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// How a vehicle stands on the ground: height of its middle, and the angles of its body.
struct Stance {
  double z = 0;      ///< m
  double roll = 0;   ///< rad, left side up
  double pitch = 0;  ///< rad, nose down (about the y axis, which points left)
};

/// Four wheels `length` by `width` metres apart on the surface: the plane through the middles of their sides.
/// Nothing where the ground below a wheel is not known.
std::optional<Stance> stand(const GroundHeight& ground, const Pose2& pose, double length = 1,
                            double width = 1);

/// What a step along the slope is on the map: shorter by the cosines of pitch and roll.
Pose2 on_map(const Pose2& step, const Stance& stance);

/// How far a line of sight dips below the tangent plane after `distance` metres on a body of radius
/// `radius`; `refraction`: part of the curvature that the air takes away (0.13 on Earth; 0 without air).
double curvature_drop(double distance, double radius, double refraction);

}  // namespace waymark
