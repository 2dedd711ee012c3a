// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
namespace waymark::inline geo {

/// Celestial body as an ellipsoid of revolution.
struct Body {
  std::string name;              ///< "Earth", "Moon", "Mars" or the ellipsoid's own name
  double equatorial_radius = 0;  ///< metres, > 0
  double flattening = 0;         ///< (a - b) / a, [0, 1)

  double polar_radius() const { return equatorial_radius * (1 - flattening); }
  /// Returns the radius of the sphere of equal volume, metres.
  double mean_radius() const;
  friend bool operator==(const Body&, const Body&) = default;
};

Body earth();  ///< WGS 84: 6378137 m, 1/298.257223563 (NIMA TR8350.2)
Body moon();   ///< IAU 2015 sphere: 1737400 m (Archinal et al. 2018)
Body mars();   ///< IAU 2015: 3396190 m, polar 3376200 m (Archinal et al. 2018)

/// Returns the body of an ellipsoid; its name is that of the known body of equal radius within 0.5 %, else
/// `name`.
Body identify_body(const std::string& name, double equatorial_radius, double flattening);

/// Position on a body.
struct LonLat {
  double lon = 0, lat = 0;  ///< degrees
};

/// Geodesics on an ellipsoid (Karney 2013, via GeographicLib), accurate to 15 nm for flattening < 1/50.
class Geodesic {
 public:
  explicit Geodesic(const Body& body);
  /// Returns the length of the geodesic in metres; about 1 us.
  double distance(LonLat from, LonLat to) const;
  /// Returns the point at `distance` metres in direction `azimuth`, degrees clockwise from north.
  LonLat direct(LonLat from, double azimuth, double distance) const;

 private:
  struct Lines;
  std::shared_ptr<const Lines> lines_;
};

}  // namespace waymark::inline geo
