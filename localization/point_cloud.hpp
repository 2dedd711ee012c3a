// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Points of one turn of a 3-D laser scanner, metres in the scanner's frame: x forward, y left, z up. The
/// frame is upright within some degrees.
struct PointCloud {
  Pose2 robot_from_sensor;
  std::vector<Eigen::Vector3f> points;  ///< those that are not finite are ignored
  /// Strengths of the returns, one per point, in the scanner's own unit; empty: not measured.
  std::vector<float> intensities = {};
};

}  // namespace waymark::localization
