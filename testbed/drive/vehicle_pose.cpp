// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/vehicle_pose.hpp"

#include <array>
#include <cmath>

namespace waymark::testbed {

Pose<GridFrame, RobotFrame> VehiclePose::grid_from_robot() const {
  Pose<GridFrame, RobotFrame> pose;
  pose.transform.linear() =
      (Eigen::AngleAxisd(plane.yaw, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  pose.transform.translation() = Eigen::Vector3d(plane.x, plane.y, z);
  return pose;
}

std::optional<VehiclePose> vehicle_pose_on(const Terrain& terrain, const localization::Pose2& plane,
                                           const Wheels& wheels) {
  const double half_base = wheels.base / 2, half_track = wheels.track / 2;
  double mean = 0, forward = 0, left = 0;
  for (const double fore : {-half_base, half_base})
    for (const double side : {-half_track, half_track}) {
      const localization::Pose2 wheel = plane * localization::Pose2{fore, side, 0};
      const auto h = terrain.height(wheel.x, wheel.y);
      if (!h) return std::nullopt;
      mean += *h / 4;
      forward += *h * (fore > 0 ? 1 : -1) / (2 * wheels.base);
      left += *h * (side > 0 ? 1 : -1) / (2 * wheels.track);
    }
  // Body axes: x along the slope at this yaw, z normal to the plane.
  const double pitch = -std::atan(forward);
  const double roll = std::atan(left * std::cos(pitch));
  return VehiclePose{plane, mean, roll, pitch};
}

}  // namespace waymark::testbed
