// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include "localization/pose2.hpp"
#include "planning/vehicle.hpp"
namespace waymark::planning {

/// Bounds that hold for every pose and every terrain within the stated errors.
struct ClearanceBounds {
  double belly = 0;  ///< metres, least distance between the belly and the terrain; negative: may touch
  double tilt = 0;   ///< degrees, largest slope of the vehicle's plane
};

/// Lowest and highest terrain of a square, metres; `std::nullopt` if some of it is unknown.
struct HeightRange {
  double low = 0, high = 0;
};
/// Returns the range of the terrain within `half` metres east, west, north and south of a position.
using TerrainRange = std::function<std::optional<HeightRange>(const Eigen::Vector2d& middle, double half)>;

/// Returns bounds of clearance and tilt at a pose, without simulating the contact (after ACE, Otsu et al.
/// 2020): each wheel stands anywhere between the lowest and the highest terrain that it can reach, and
/// intervals are propagated to the plane of the vehicle.
/// - `position_error`: metres, by which the pose may be off in any direction; `height_error`: metres.
/// - rigid: the plane through any three supports about the middle; bogies: the mean plane of all supports.
/// - `std::nullopt` on unknown terrain.
std::optional<ClearanceBounds> clearance_bounds(const localization::Pose2& pose, const Vehicle& vehicle,
                                                const TerrainRange& terrain, double position_error,
                                                double height_error);

}  // namespace waymark::planning
