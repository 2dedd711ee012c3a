// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>
#include "localization/pose2.hpp"
namespace waymark::localization {

/// One sweep of a line scanner. Beam i points at first_angle + i angle_step, radians from the sensor's x
/// axis (forward) to the left.
struct LaserScan {
  Pose2 robot_from_sensor;
  double first_angle = 0, angle_step = 0;
  std::vector<float> ranges;  ///< m; not finite, <= 0 or >= max_range: no return
  double max_range = 80;      ///< m
  double roll = 0,
         pitch = 0;  ///< rad, of the vehicle, if the scanner tilts with it: Rz(yaw) Ry(pitch) Rx(roll)
  /// Angle, rad, by which an object looks wider than it is: a beam has a width and returns if part of it
  /// hits.
  std::optional<double> beam_width = {};
  /// Strengths of the returns, one per beam, in the scanner's own unit; empty: not measured.
  std::vector<float> intensities = {};
};

/// Points of one turn of a 3-D laser scanner, metres in the scanner's frame: x forward, y left, z up. The
/// frame is upright within some degrees.
struct PointCloud {
  Pose2 robot_from_sensor;
  std::vector<Eigen::Vector3f> points;  ///< those that are not finite are ignored
  /// Strengths of the returns, one per point, in the scanner's own unit; empty: not measured.
  std::vector<float> intensities = {};
};

}  // namespace waymark::localization
