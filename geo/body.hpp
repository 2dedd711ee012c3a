// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
namespace waymark {

/// A celestial body as an ellipsoid of revolution.
struct Body {
  std::string name;              ///< "Earth", "Moon", "Mars" or the ellipsoid's own name
  double equatorial_radius = 0;  ///< metres, > 0
  double flattening = 0;         ///< (a - b) / a, [0, 1)

  double polar_radius() const { return equatorial_radius * (1 - flattening); }
  /// Radius of the sphere of equal volume, metres.
  double mean_radius() const;
  friend bool operator==(const Body&, const Body&) = default;
};

Body earth();  ///< WGS 84: 6378137 m, 1/298.257223563 (NIMA TR8350.2)
Body moon();   ///< IAU 2015 sphere: 1737400 m (Archinal et al. 2018)
Body mars();   ///< IAU 2015: 3396190 m, polar 3376200 m (Archinal et al. 2018)

/// The body an ellipsoid belongs to, named after the known body whose radius agrees within 0.5 %; else
/// `name`.
Body body_of_ellipsoid(const std::string& name, double equatorial_radius, double flattening);

struct LonLat {
  double lon = 0, lat = 0;  ///< degrees
};

/// Geodesics on a body's ellipsoid (Karney 2013, via GeographicLib); good to 15 nm for flattening < 1/50.
class Geodesic {
 public:
  explicit Geodesic(const Body& body);
  /// Metres; about 1 us.
  double distance(LonLat from, LonLat to) const;
  /// The point reached after `distance` metres at `azimuth` degrees clockwise from north.
  LonLat direct(LonLat from, double azimuth, double distance) const;

 private:
  struct Lines;
  std::shared_ptr<const Lines> lines_;
};

}  // namespace waymark
