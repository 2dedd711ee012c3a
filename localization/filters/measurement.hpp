// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/pose2.hpp"
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

/// Returns the measurement expected at a pose. Of a sighted line, row 0 is the sensor's distance from it,
/// negative behind it, and row 1 is 0.
ExpectedSighting expect(const Pose2& robot, const Pose2& robot_from_sensor, const SeenLandmark& seen,
                        const MapLandmark& landmark);

/// Returns whether the sighted piece of a line may belong to a line of the map. `slack`: metres by which the
/// sensor may lie elsewhere along it.
bool may_overlap(const LineExtent& seen, const Eigen::Vector2d& sensor, const MapLandmark& line,
                 double slack);

/// Returns the variance of the distance from a line that its uncertain direction causes at the sensor, m^2.
double swing_variance(const MapLandmark& line, const Eigen::Vector2d& sensor);

/// Returns measured minus expected, the bearing wrapped. The row of a missing number is 0.
Eigen::Vector2d innovation(const SeenLandmark& seen, const Eigen::Vector2d& expected);

/// Returns the covariance of the measurement. A missing number has variance 1; the caller must omit its row.
Eigen::Matrix2d sensor_noise(const SeenLandmark& seen);

/// Sets the rows of missing numbers to 0 in the derivatives, and their correlations in the noise. An update
/// then ignores them.
template <class ByPose>
void omit_missing(const SeenLandmark& seen, ByPose& by_pose, Eigen::Matrix2d& by_landmark,
                  Eigen::Matrix2d& noise) {
  if (seen.has_position()) return;
  const int missing = seen.range ? 1 : 0;
  by_pose.row(missing).setZero(), by_landmark.row(missing).setZero();
  noise(0, 1) = noise(1, 0) = 0;
}

/// Returns a range without bearing as a filter to first order must take it: corrected for the curvature of
/// its circle within the uncertainty of the pose, and with that variance added (second-order filter,
/// Bar-Shalom et al. 2001, 10.3). Returns other sightings as they are.
SeenLandmark correct_curvature(const SeenLandmark& seen, const PoseEstimate& robot,
                               const Pose2& robot_from_sensor, const Eigen::Vector2d& landmark);

/// Returns v' S^-1 v over the rows that a sighting measures.
double squared_distance(const SeenLandmark& seen, const Eigen::Vector2d& innovation,
                        const Eigen::Matrix2d& covariance);

}  // namespace waymark::localization
