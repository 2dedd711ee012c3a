// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include "core/frames.hpp"
#include "geo/body.hpp"
#include "geo/crs.hpp"
namespace waymark::inline landmarks {

/// Distances between positions on the surface of a body. A position is longitude and latitude in degrees, or
/// x and y of a local CRS. Thread-safe.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const Crs& crs);
  ~SurfaceDistance();

  /// Returns the position of a point of the map.
  Eigen::Vector2d position(const Point<MapCrs>& point) const;
  /// Returns the horizontal distance in metres: the geodesic on the ellipsoid, or the straight line in a
  /// local CRS.
  double distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Returns the geocentric Cartesian coordinates in metres; x, y, 0 for a local CRS. The chord between two
  /// positions is never longer than their distance.
  Eigen::Vector3d cartesian(const Eigen::Vector2d& position) const;

 private:
  struct ToDegrees;
  Crs crs_;
  std::optional<Geodesic> geodesic_;       // on a body
  std::unique_ptr<ToDegrees> to_degrees_;  // of a projected CRS
};

}  // namespace waymark::inline landmarks
