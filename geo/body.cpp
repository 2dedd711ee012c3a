// SPDX-License-Identifier: Apache-2.0
#include "geo/body.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <cmath>

namespace waymark {

double Body::mean_radius() const { return std::cbrt(equatorial_radius * equatorial_radius * polar_radius()); }

Body earth() { return {"Earth", 6378137, 1 / 298.257223563}; }
Body moon() { return {"Moon", 1737400, 0}; }
Body mars() { return {"Mars", 3396190, (3396190.0 - 3376200.0) / 3396190.0}; }

Body body_of_ellipsoid(const std::string& name, double equatorial_radius, double flattening) {
  for (const Body& known : {earth(), moon(), mars()})
    if (std::abs(equatorial_radius / known.equatorial_radius - 1) < 0.005)
      return {known.name, equatorial_radius, flattening};
  return {name, equatorial_radius, flattening};
}

double geodesic_distance(const Body& body, double lon1, double lat1, double lon2, double lat2) {
  const GeographicLib::Geodesic geodesic(body.equatorial_radius, body.flattening);
  double distance = 0;
  geodesic.Inverse(lat1, lon1, lat2, lon2, distance);
  return distance;
}

LonLat geodesic_direct(const Body& body, LonLat from, double azimuth, double distance) {
  const GeographicLib::Geodesic geodesic(body.equatorial_radius, body.flattening);
  LonLat to;
  geodesic.Direct(from.lat, from.lon, azimuth, distance, to.lat, to.lon);
  return to;
}

}  // namespace waymark
