// SPDX-License-Identifier: Apache-2.0
#include "geo/geocentric.hpp"

#include <GeographicLib/Geocentric.hpp>

namespace waymark::inline geo {

Eigen::Vector3d geocentric(const Body& body, const Geodetic& position) {
  Eigen::Vector3d point;
  GeographicLib::Geocentric(body.equatorial_radius, body.flattening)
      .Forward(position.at.lat, position.at.lon, position.height, point.x(), point.y(), point.z());
  return point;
}

Geodetic geodetic(const Body& body, const Eigen::Vector3d& point) {
  Geodetic position;
  GeographicLib::Geocentric(body.equatorial_radius, body.flattening)
      .Reverse(point.x(), point.y(), point.z(), position.at.lat, position.at.lon, position.height);
  return position;
}

}  // namespace waymark::inline geo
