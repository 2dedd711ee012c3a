// SPDX-License-Identifier: Apache-2.0
#include "localization/terrain_pose.hpp"

#include <algorithm>

namespace waymark::localization {

std::optional<TerrainPose> pose_on_terrain(const TerrainHeight& ground, const Pose2& pose, double length,
                                           double width) {
  const auto at = [&](double ahead, double left) {
    return ground((pose * Pose2{ahead * length / 2, left * width / 2, 0}).at());
  };
  const auto front_left = at(1, 1), front_right = at(1, -1), back_left = at(-1, 1), back_right = at(-1, -1);
  if (!front_left || !front_right || !back_left || !back_right) return {};
  const double front = (*front_left + *front_right) / 2, back = (*back_left + *back_right) / 2;
  const double left = (*front_left + *back_left) / 2, right = (*front_right + *back_right) / 2;
  return TerrainPose{(front + back) / 2, std::atan2(left - right, width), std::atan2(back - front, length)};
}

Pose2 project_to_map(const Pose2& step, const TerrainPose& terrain_pose) {
  return {step.x * std::cos(terrain_pose.pitch), step.y * std::cos(terrain_pose.roll), step.yaw};
}

double curvature_drop(double distance, double radius, double refraction) {
  return radius > 0 ? (1 - refraction) * distance * distance / (2 * radius) : 0;
}

}  // namespace waymark::localization
