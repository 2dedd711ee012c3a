// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
namespace waymark::inline core {

struct MapCrs;       ///< x, y in the units of the map's CRS (x = easting or longitude), z in metres
struct MapFrame;     ///< east, north, up in metres about the map's origin
struct GridFrame;    ///< x, y: easting and northing of a projected or local CRS, z: height; all metres,
                     ///< taken as Cartesian. Frame of cameras, sun directions and rays
struct CameraFrame;  ///< x right, y down, z forward, metres (OpenCV)
struct RobotFrame;   ///< x forward, y left, z up, metres

/// Position in a frame, in its units.
template <class Frame>
struct Point {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  friend bool operator==(const Point&, const Point&) = default;
};

/// Unit vector in a frame.
template <class Frame>
struct Direction {
  Eigen::Vector3d unit = Eigen::Vector3d::UnitX();
};

/// Half-line from a point.
template <class Frame>
struct Ray {
  Point<Frame> origin;
  Direction<Frame> direction;
};

/// Rigid motion that maps a Point<From> to a Point<To>. Variables are named `to_from_from`, e.g.
/// `map_from_camera`. Composing poses of different inner frames does not compile.
template <class To, class From>
struct Pose {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();

  Point<To> operator*(const Point<From>& p) const { return {transform * p.xyz}; }
  Direction<To> operator*(const Direction<From>& d) const { return {transform.linear() * d.unit}; }
  template <class Source>
  Pose<To, Source> operator*(const Pose<From, Source>& next) const {
    return {transform * next.transform};
  }
  Pose<From, To> inverse() const { return {transform.inverse()}; }
};

}  // namespace waymark::inline core
