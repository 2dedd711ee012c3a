// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "geo/crs.hpp"
#include "geo/local_frame.hpp"
namespace waymark::inline geo {

/// Returns the rotation from the axes of one CRS to those of another at a position of the first, radians,
/// counter-clockwise. `transform`: between the two.
/// - It is added to an angle counted from the x axis, and subtracted from one clockwise from the y axis (map
///   north).
/// - In degrees the axes are east and north. In a projection that is not conformal it is the rotation nearest
///   to the distorted axes.
/// - 0 where the position has no place in the other CRS.
double axes_rotation(const CrsTransform& transform, const Crs& from, const Crs& to, double x, double y);

/// Returns the rotation from the axes of the map frame to those of the map's CRS at a position of the map
/// frame, radians, counter-clockwise.
/// - It is added to a yaw in the map frame: a pose in the CRS points along its own track.
/// - In a projected CRS it is the meridian convergence, and any angle in a polar one; in degrees the axes are
///   east and north of the position; in a local CRS it is 0.
/// - In a projection that is not conformal it is the rotation nearest to the distorted axes.
double grid_rotation(const LocalFrame& frame, const Eigen::Vector2d& position);

}  // namespace waymark::inline geo
