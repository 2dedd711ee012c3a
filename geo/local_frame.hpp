// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "core/frames.hpp"
#include "geo/crs.hpp"
namespace waymark {

/// East, north, up in metres about an origin: the frame robots drive in. On a body it is the plane that
/// touches the ellipsoid there (GeographicLib::LocalCartesian), exact at any distance; in a local CRS it is a
/// shift. z of the map is taken as height above the ellipsoid. May be asked from many threads.
class LocalFrame {
 public:
  LocalFrame(const Crs& crs, const Point<MapCrs>& origin);

  const Point<MapCrs>& origin() const;
  Point<MapFrame> map_frame_from_crs(const Point<MapCrs>& point) const;
  Point<MapCrs> crs_from_map_frame(const Point<MapFrame>& point) const;

 private:
  struct Conversion;
  std::shared_ptr<const Conversion> conversion_;
};

}  // namespace waymark
