// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/frames.hpp"
#include "geo/terrain.hpp"
#include "localization/pose2.hpp"
namespace waymark::testbed {

/// Wheel contact points, metres.
struct Wheels {
  double base = 1.6;   ///< front to rear axle
  double track = 1.4;  ///< left to right
};

/// Pose of a vehicle on the terrain. R = Rz(yaw) Ry(pitch) Rx(roll) with x forward, y left, z up: pitch > 0
/// is nose down, roll > 0 leans to the right.
struct VehiclePose {
  localization::Pose2 plane;
  double z = 0, roll = 0, pitch = 0;

  Pose<GridFrame, RobotFrame> grid_from_robot() const;
};

/// Returns the pose of a vehicle at a planar pose, on the least-squares plane through the heights under its
/// four wheels. `std::nullopt` if a wheel is outside the known terrain.
std::optional<VehiclePose> vehicle_pose_on(const Terrain& terrain, const localization::Pose2& plane,
                                           const Wheels& wheels);

}  // namespace waymark::testbed
