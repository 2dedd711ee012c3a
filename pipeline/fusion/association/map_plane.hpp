// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "geo/body.hpp"
#include "geo/crs.hpp"
namespace waymark::pipeline {

/// Converts between CRS units and metres for neighbouring points of a map, by a plane tangent to the
/// ellipsoid between them.
/// Exact for projected and local CRSs. For geographic CRSs better than 1e-4 of the distance up to 100 km and
/// 80 degrees of latitude; longitudes may differ by full turns.
class MapPlane {
 public:
  explicit MapPlane(const Crs& crs);

  /// Returns the vector from a to b, metres east and north. a and b in CRS units.
  Eigen::Vector2d offset(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    if (!geographic_) return (b - a) * metres_per_unit_;
    const Eigen::Vector2d scale = metres_per_degree((a.y() + b.y()) / 2);
    return {wrapped(b.x() - a.x()) * scale.x(), (b.y() - a.y()) * scale.y()};
  }
  /// Returns the point `east_north` metres from a, CRS units.
  Eigen::Vector2d translate(const Eigen::Vector2d& a, const Eigen::Vector2d& east_north) const {
    if (!geographic_) return a + east_north / metres_per_unit_;
    const double north = east_north.y() / metres_per_degree(a.y()).y();
    const Eigen::Vector2d scale = metres_per_degree(a.y() + north / 2);
    return {wrapped(a.x() + east_north.x() / scale.x()), a.y() + east_north.y() / scale.y()};
  }
  /// Returns the point in Cartesian coordinates, metres; z = 0 on a plane. Chords exceed offsets by at most
  /// 1e-4.
  Eigen::Vector3d to_cartesian(const Eigen::Vector2d& position) const;
  bool flat() const { return !geographic_; }

 private:
  Eigen::Vector2d metres_per_degree(double latitude) const;
  static double wrapped(double degrees);

  bool geographic_ = false;
  double metres_per_unit_ = 1;
  double radius_ = 0, eccentricity2_ = 0;
};

}  // namespace waymark::pipeline
