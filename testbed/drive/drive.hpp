// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "testbed/drive/vehicle_motion.hpp"
namespace waymark::testbed {

/// Follows a path by its true pose. Deterministic for a seed. Throws Error{usage} if the path leaves the
/// terrain.
std::vector<DriveStep> drive_along(const Terrain& terrain, std::span<const Eigen::Vector2d> path,
                                   const DriveSettings& settings, std::uint64_t seed);

}  // namespace waymark::testbed
