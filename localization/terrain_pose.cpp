// SPDX-License-Identifier: Apache-2.0
#include "localization/terrain_pose.hpp"

#include <cmath>

namespace waymark::localization {

Pose<GridFrame, RobotFrame> TerrainPose::grid_from_robot() const {
  Pose<GridFrame, RobotFrame> pose;
  pose.transform.linear() =
      (Eigen::AngleAxisd(plane.yaw, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  pose.transform.translation() = Eigen::Vector3d(plane.x, plane.y, z);
  return pose;
}

std::optional<TerrainPose> pose_on_terrain(const TerrainHeight& ground, const Pose2& plane,
                                           const Wheels& wheels) {
  const double half_base = wheels.base / 2, half_track = wheels.track / 2;
  double mean = 0, forward = 0, left = 0;
  for (const double fore : {-half_base, half_base})
    for (const double side : {-half_track, half_track}) {
      const auto h = ground((plane * Pose2{fore, side, 0}).at());
      if (!h) return std::nullopt;
      mean += *h / 4;
      forward += *h * (fore > 0 ? 1 : -1) / (2 * wheels.base);
      left += *h * (side > 0 ? 1 : -1) / (2 * wheels.track);
    }
  // Body axes: x along the slope at this yaw, z normal to the plane.
  const double pitch = -std::atan(forward);
  const double roll = std::atan(left * std::cos(pitch));
  return TerrainPose{plane, mean, roll, pitch};
}

Pose2 project_to_map(const Pose2& step, const TerrainPose& terrain_pose) {
  return {step.x * std::cos(terrain_pose.pitch), step.y * std::cos(terrain_pose.roll), step.yaw};
}

double curvature_drop(double distance, double radius, double refraction) {
  return radius > 0 ? (1 - refraction) * distance * distance / (2 * radius) : 0;
}

}  // namespace waymark::localization
