// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Predicted measurement of a landmark and its Jacobians. Row 0: range in metres, row 1: bearing in
/// radians, relative to the sensor.
struct ExpectedSighting {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
};

/// Returns the measurement expected at a pose. Derivatives grow without bound near the landmark; a range
/// below 1 mm is taken as 1 mm.
ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const Eigen::Vector2d& landmark);

/// Returns measured minus expected, the bearing wrapped. Row 0 is 0 for a sighting without range.
Eigen::Vector2d innovation(const SeenLandmark& seen, const Eigen::Vector2d& expected);

/// Returns the covariance of the measurement. A missing range has variance 1; the caller must omit its row.
Eigen::Matrix2d sensor_noise(const SeenLandmark& seen);

}  // namespace waymark::localization
