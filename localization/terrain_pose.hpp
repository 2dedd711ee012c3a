// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Returns the height of the terrain at a position of the map frame, metres above the datum. `std::nullopt`
/// where it is unknown.
using TerrainHeight = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// Height and attitude of a vehicle that stands on the terrain.
struct TerrainPose {
  double z = 0;      ///< m, of its centre
  double roll = 0;   ///< rad, left side up
  double pitch = 0;  ///< rad, nose down (about the y axis, which points left)
};

/// Returns the pose of a vehicle on four wheels, `length` by `width` metres apart, that stands on the
/// terrain at `pose`. It is the plane through the midpoints of the sides. `std::nullopt` where the terrain
/// below a wheel is unknown.
std::optional<TerrainPose> pose_on_terrain(const TerrainHeight& ground, const Pose2& pose, double length = 1,
                                           double width = 1);

/// Projects a step along the slope to the map plane: shorter by the cosines of pitch and roll.
Pose2 project_to_map(const Pose2& step, const TerrainPose& terrain_pose);

/// Returns how far a line of sight of `distance` metres lies below the tangent plane, on a body of radius
/// `radius` metres. `refraction` is the fraction of the curvature that air compensates: 0.13 on Earth, 0
/// without air.
double curvature_drop(double distance, double radius, double refraction);

}  // namespace waymark::localization
