// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "testbed/drive/vehicle_motion.hpp"
namespace waymark::testbed {

/// Drive to the end of a path, or to a mishap.
struct PathDrive {
  std::vector<DriveStep> steps;
  std::string mishap;  ///< as VehicleMotion::mishap(); empty at the end of the path
};

/// Follows a path by its true pose. Deterministic for a seed. Throws Error{usage} if the path leaves the
/// terrain. Rocks matter to a vehicle with dynamics alone.
PathDrive drive_along(const Terrain& terrain, std::span<const RockSolid> rocks,
                      std::span<const Eigen::Vector2d> path, const DriveSettings& settings,
                      std::uint64_t seed);

}  // namespace waymark::testbed
