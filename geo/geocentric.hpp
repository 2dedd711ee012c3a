// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "geo/body.hpp"
namespace waymark::inline geo {

/// Position on a body with the height above its ellipsoid.
struct Geodetic {
  LonLat at = {};
  double height = 0;  ///< metres
};

/// Returns Cartesian coordinates from the body's centre, metres: x through the prime meridian, z through the
/// north pole (GeographicLib::Geocentric).
Eigen::Vector3d geocentric(const Body& body, const Geodetic& position);

/// Returns the position of a point by Cartesian coordinates; accurate to nanometres outside of the core.
Geodetic geodetic(const Body& body, const Eigen::Vector3d& point);

}  // namespace waymark::inline geo
