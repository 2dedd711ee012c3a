// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/local_frame.hpp"
namespace waymark::inline geo {

/// Returns east and north in the map frame of x, y in the map's CRS on ground as high as the frame's origin.
/// - Ground h higher or lower there moves the position by h / R of its distance from the origin: 0.3 m for
///   1 km and 1 km on Mars.
Eigen::Vector2d plan_position(const LocalFrame& frame, double x, double y);

/// Returns the point of a height above the ellipsoid, metres, whose east and north in the map frame are
/// given.
/// - The vertical there leans against that of the origin: with `height` left out, 50 km from the origin and
///   4 km high, the point lies 31 m aside.
/// - Two conversions: below 1 mm aside and 0.2 m high for these numbers. In a local CRS exact.
Point<MapCrs> point_at_height(const LocalFrame& frame, const Eigen::Vector2d& position, double height);

/// Returns the same for x, y and height of a pose; a height of 0 is unknown: the point on the plane through
/// the frame's origin.
Point<MapCrs> point_of_pose(const LocalFrame& frame, const Eigen::Vector3d& pose);

}  // namespace waymark::inline geo
