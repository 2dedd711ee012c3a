// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/sighting.hpp"
namespace waymark {

/// Range and bearing of a landmark as a robot at a pose should see it, and their derivatives. Row 0: range in
/// metres, row 1: bearing in radians, relative to the sensor.
struct ExpectedSighting {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
};

/// Derivatives grow without bound as the landmark comes close; below 1 mm the range is taken as 1 mm.
ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const Eigen::Vector2d& landmark);

/// Measured minus expected, the bearing the short way round. Row 0 is 0 for a sighting without range.
Eigen::Vector2d innovation(const SeenLandmark& seen, const Eigen::Vector2d& expected);

/// Sensor noise. A missing range has variance 1 and must be left out by who uses it.
Eigen::Matrix2d sensor_noise(const SeenLandmark& seen);

}  // namespace waymark
