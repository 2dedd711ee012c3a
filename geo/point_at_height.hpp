// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/local_frame.hpp"
namespace waymark::inline geo {

/// Returns the point of a height above the ellipsoid, metres, whose east and north in the map frame are
/// given.
/// - The vertical there leans against that of the origin: with `height` left out, 50 km from the origin and
///   4 km high, the point lies 31 m aside.
/// - Two conversions: below 1 mm aside and 0.2 m high for these numbers. In a local CRS exact.
Point<MapCrs> point_at_height(const LocalFrame& frame, const Eigen::Vector2d& place, double height);

}  // namespace waymark::inline geo
