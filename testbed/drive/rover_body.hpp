// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/frames.hpp"
#include "geo/terrain.hpp"
#include "localization/pose2.hpp"
namespace waymark {

/// Where wheels touch the ground, metres.
struct Wheels {
  double base = 1.6;   ///< front to rear axle
  double track = 1.4;  ///< left to right
};

/// A body on the ground. Angles as in R = Rz(yaw) Ry(pitch) Rx(roll) with x forward, y left, z up: pitch > 0
/// looks down, roll > 0 leans to the right.
struct StandingPose {
  Pose2 plane;
  double z = 0, roll = 0, pitch = 0;

  Pose<GridFrame, RobotFrame> grid_from_robot() const;
};

/// The body at a place of the plane, on the plane through the heights under its four wheels (least squares).
/// Nothing where a wheel is beyond the known ground.
std::optional<StandingPose> stand_on(const Terrain& terrain, const Pose2& plane, const Wheels& wheels);

}  // namespace waymark
