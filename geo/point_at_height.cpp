// SPDX-License-Identifier: Apache-2.0
#include "geo/point_at_height.hpp"

namespace waymark::inline geo {

Eigen::Vector2d plan_position(const LocalFrame& frame, double x, double y) {
  return frame.map_frame_from_crs({{x, y, frame.origin().xyz.z()}}).xyz.head<2>();
}

Point<MapCrs> point_at_height(const LocalFrame& frame, const Eigen::Vector2d& position, double height) {
  const double plane = frame.crs_from_map_frame({{position.x(), position.y(), 0}}).xyz.z();
  return frame.crs_from_map_frame({{position.x(), position.y(), height - plane}});
}

Point<MapCrs> point_of_pose(const LocalFrame& frame, const Eigen::Vector3d& pose) {
  return pose.z() != 0 ? point_at_height(frame, pose.head<2>(), pose.z()) : frame.crs_from_map_frame({pose});
}

}  // namespace waymark::inline geo
