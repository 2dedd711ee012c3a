// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "geo/terrain.hpp"
#include "testbed/drive/drive_settings.hpp"
namespace waymark::testbed {

/// State of a simulated drive: true pose, and the odometry reading until the next step.
struct DriveStep {
  double t = 0;
  localization::TerrainPose at;
  double distance = 0;         ///< metres driven along the route
  double speed = 0, turn = 0;  ///< measured by odometry, m/s and rad/s, until the next step
};

/// Follows a path by pure pursuit (Coulter 1992) with slip that depends on the slope. Deterministic for a
/// seed. Throws Error{usage} if the path leaves the terrain.
std::vector<DriveStep> drive_along(const Terrain& terrain, std::span<const Eigen::Vector2d> path,
                                   const DriveSettings& settings, std::uint64_t seed);

}  // namespace waymark::testbed
