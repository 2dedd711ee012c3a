// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "exporters/records/lonlat_footprint.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Radius in metres of the sphere that map libraries for the web assume.
inline constexpr double kWebRadius = 6371008.8;
/// Largest latitude of the square world of web maps, degrees.
inline constexpr double kMaxWebLatitude = 85.05112877980659;

/// How positions lie on the square world of web maps.
enum class WebPlane {
  mercator,  ///< longitude and latitude on the body through the spherical Mercator formula
  metres,    ///< x and y of a local or polar CRS, to scale on a plane that touches kWebRadius at (0, 0)
};

/// Returns `metres` for a local CRS, and for a projected one whose landmarks reach beyond kMaxWebLatitude;
/// else `mercator`. `extent`: of the landmarks, unknown for an empty map.
WebPlane web_plane(const Crs& crs, const std::optional<MapBox>& extent);

/// Positions of a map's CRS on the square world: x east and y south in [0, 1), both 0.5 at longitude and
/// latitude 0 or at x = y = 0. Not thread-safe: create one per thread (~2 ms).
class WebProjection {
 public:
  WebProjection(const Crs& crs, WebPlane plane);

  /// Returns the position on the world; `std::nullopt` beyond its edges. Longitudes differ by whole turns.
  std::optional<Eigen::Vector2d> to_world(double x, double y) const;
  /// Returns the position in the map's CRS; NaN if it has no image.
  Eigen::Vector2d from_world(const Eigen::Vector2d& world) const;
  /// Returns the metres on the ground that the width of the world measures at this height of the world.
  double world_width(double world_y) const;

 private:
  WebPlane plane_;
  Crs crs_, lonlat_;
  CrsTransform to_lonlat_, from_lonlat_;
};

/// Rectangle of the world.
struct WebBounds {
  double west = 0, north = 0, east = 1, south = 1;
};

/// Returns the longitude or latitude that web maps give a position on the world, degrees.
double web_longitude(double world_x);
double web_latitude(double world_y);

}  // namespace waymark::exporters
