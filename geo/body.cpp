// SPDX-License-Identifier: Apache-2.0
#include "geo/body.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <cmath>

namespace waymark::inline geo {

double Body::mean_radius() const {
  return std::cbrt(equatorial_radius * equatorial_radius * polar_radius());
}

Body earth() {
  return {"Earth", 6378137, 1 / 298.257223563};
}
Body moon() {
  return {"Moon", 1737400, 0};
}
Body mars() {
  return {"Mars", 3396190, (3396190.0 - 3376200.0) / 3396190.0};
}

Body identify_body(const std::string& name, double equatorial_radius, double flattening) {
  for (const Body& known : {earth(), moon(), mars()})
    if (std::abs(equatorial_radius / known.equatorial_radius - 1) < 0.005)
      return {known.name, equatorial_radius, flattening};
  return {name, equatorial_radius, flattening};
}

struct Geodesic::Lines {
  GeographicLib::Geodesic solve;
};

Geodesic::Geodesic(const Body& body)
    : lines_(std::make_shared<const Lines>(Lines{{body.equatorial_radius, body.flattening}})) {}

double Geodesic::distance(LonLat from, LonLat to) const {
  double metres = 0;
  lines_->solve.Inverse(from.lat, from.lon, to.lat, to.lon, metres);
  return metres;
}

LonLat Geodesic::direct(LonLat from, double azimuth, double distance) const {
  LonLat to;
  lines_->solve.Direct(from.lat, from.lon, azimuth, distance, to.lat, to.lon);
  return to;
}

}  // namespace waymark::inline geo
