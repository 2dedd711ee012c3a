// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include "core/frames.hpp"
#include "geo/body.hpp"
#include "geo/crs.hpp"
namespace waymark {

/// Places on the ground, for distances: longitude and latitude in degrees, or x and y of a local CRS.
class Ground {
 public:
  explicit Ground(const Crs& crs);
  ~Ground();

  Eigen::Vector2d place(const Point<MapCrs>& point) const;
  /// Metres over the ground, height apart: the geodesic of the ellipsoid, or the straight line of a local
  /// CRS.
  double distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// The place in space, metres, where no meridian and no pole is special. The chord between two places is
  /// never longer than their distance.
  Eigen::Vector3d in_space(const Eigen::Vector2d& place) const;

 private:
  struct ToDegrees;
  Crs crs_;
  std::optional<Geodesic> geodesic_;       // on a body
  std::unique_ptr<ToDegrees> to_degrees_;  // of a projected CRS
};

}  // namespace waymark
