// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Depth image of a stereo pair or a time-of-flight camera. The camera's axes are x forward, y left, z up,
/// pitched down by `tilt`. Pixel (c, r) looks along (1, -(c - cx) / f, -(r - cy) / f).
struct DepthImage {
  Pose2 robot_from_sensor;     ///< on the horizontal plane
  double height = 1.5;         ///< m of the camera above the ground under the robot
  double tilt = 0;             ///< rad, downwards
  double roll = 0, pitch = 0;  ///< rad, of the robot: Rz(yaw) Ry(pitch) Rx(roll)
  std::int64_t columns = 0, rows = 0;
  double focal = 1;           ///< pixels
  std::vector<float> depths;  ///< m along the optical axis, row by row; <= 0 or not finite: unknown

  Eigen::Vector3d ray(std::int64_t column, std::int64_t row) const {
    return {1, -(double(column) - 0.5 * double(columns - 1)) / focal,
            -(double(row) - 0.5 * double(rows - 1)) / focal};
  }
};

}  // namespace waymark::localization
