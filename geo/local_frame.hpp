// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "core/frames.hpp"
#include "geo/crs.hpp"
namespace waymark::inline geo {

/// Local Cartesian frame: east, north, up in metres about an origin; the frame of the robot's pose.
/// - On a body it is tangent to the ellipsoid at the origin (GeographicLib::LocalCartesian), exact at any
///   distance. In a local CRS it is a translation.
/// - z of the map is taken as height above the ellipsoid.
/// - Thread-safe.
class LocalFrame {
 public:
  LocalFrame(const Crs& crs, const Point<MapCrs>& origin);

  const Crs& crs() const;
  const Point<MapCrs>& origin() const;
  Point<MapFrame> map_frame_from_crs(const Point<MapCrs>& point) const;
  Point<MapCrs> crs_from_map_frame(const Point<MapFrame>& point) const;

 private:
  struct Conversion;
  std::shared_ptr<const Conversion> conversion_;
};

}  // namespace waymark::inline geo
