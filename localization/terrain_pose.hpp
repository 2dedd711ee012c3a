// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include "core/frames.hpp"
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Returns the height of the terrain at a position of the map frame, metres above the datum. `std::nullopt`
/// where it is unknown.
using TerrainHeight = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// Wheel contact points, metres.
struct Wheels {
  double base = 1;   ///< front to rear axle
  double track = 1;  ///< left to right
};

/// Pose of a vehicle that stands on the terrain. R = Rz(yaw) Ry(pitch) Rx(roll) with x forward, y left, z up.
struct TerrainPose {
  Pose2 plane;       ///< in the map plane
  double z = 0;      ///< m, of its centre
  double roll = 0;   ///< rad, left side up
  double pitch = 0;  ///< rad, nose down (about the y axis, which points left)

  Pose<GridFrame, RobotFrame> grid_from_robot() const;
};

/// Returns the pose of a vehicle on the terrain at a planar pose: on the least-squares plane through the
/// heights under its four wheels. `std::nullopt` where the terrain below a wheel is unknown.
std::optional<TerrainPose> pose_on_terrain(const TerrainHeight& ground, const Pose2& plane,
                                           const Wheels& wheels = {});

/// Projects a step along the slope to the map plane: shorter by the cosines of pitch and roll.
Pose2 project_to_map(const Pose2& step, const TerrainPose& terrain_pose);

/// Returns how far a line of sight of `distance` metres lies below the tangent plane, on a body of radius
/// `radius` metres. `refraction` is the fraction of the curvature that air compensates: 0.13 on Earth, 0
/// without air.
double curvature_drop(double distance, double radius, double refraction);

}  // namespace waymark::localization
