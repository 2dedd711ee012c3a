// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "testbed/drive/drive_settings.hpp"
namespace waymark {

/// A moment of a drive: where the vehicle truly is, and what odometry says of the time until the next.
struct DriveStep {
  double t = 0;
  StandingPose at;
  double way = 0;              ///< metres along the route
  double speed = 0, turn = 0;  ///< told, m/s and rad/s; hold until the next step
};

/// Follows a way (pure pursuit, Coulter 1992) with slip that depends on the slope. The same for the same
/// seed. Throws Error{usage} where the way leaves the ground.
std::vector<DriveStep> drive_along(const Terrain& terrain, std::span<const Eigen::Vector2d> way,
                                   const DriveSettings& settings, std::uint64_t seed);

}  // namespace waymark
