// SPDX-License-Identifier: Apache-2.0
#include "geo/point_at_height.hpp"

namespace waymark::inline geo {

Point<MapCrs> point_at_height(const LocalFrame& frame, const Eigen::Vector2d& place, double height) {
  const double plane = frame.crs_from_map_frame({{place.x(), place.y(), 0}}).xyz.z();
  return frame.crs_from_map_frame({{place.x(), place.y(), height - plane}});
}

}  // namespace waymark::inline geo
