// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/crs.hpp"
namespace waymark::inline geo {

/// Returns the rotation from the axes of one CRS to those of another at a position of the first, radians,
/// counter-clockwise. `transform`: between the two.
/// - It is added to an angle counted from the x axis, and subtracted from one clockwise from the y axis (map
///   north).
/// - In degrees the axes are east and north. In a projection that is not conformal it is the rotation nearest
///   to the distorted axes.
/// - 0 where the position has no place in the other CRS.
double axes_rotation(const CrsTransform& transform, const Crs& from, const Crs& to, double x, double y);

}  // namespace waymark::inline geo
