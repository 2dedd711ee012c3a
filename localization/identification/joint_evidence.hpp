// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "localization/absolute_fix.hpp"
#include "localization/filters/measurement.hpp"
namespace waymark::localization {

/// Information about the pose from a set of pairings, in information form. Adding a pairing is a sum. Joint
/// compatibility (Neira & Tardos 2001) and the Kalman update then cost a 3x3 solve, for any number of
/// sightings.
struct JointEvidence {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();         ///< sum of H' R^-1 H
  Eigen::Vector3d information_vector = Eigen::Vector3d::Zero();  ///< sum of H' R^-1 v
  double squares = 0;                                            ///< sum of v' R^-1 v
  double log_det = 0;                                            ///< sum of ln |R|
  int rows = 0;                                                  ///< numbers measured

  JointEvidence& operator+=(const JointEvidence& more);
  friend JointEvidence operator+(JointEvidence a, const JointEvidence& b) { return a += b; }
};

/// Returns the evidence of one pairing. R is the sensor's noise plus the landmark's covariance, divided by
/// `trust` in (0, 1].
JointEvidence evidence_of(const SeenLandmark& seen, const ExpectedSighting& expected,
                          const Eigen::Matrix2d& landmark_covariance, double trust = 1);

/// Returns the evidence of an angle that repeats after `period` and measures the heading of the robot.
/// Its density is that of angles over the period: compared with objects that face anywhere.
JointEvidence evidence_of(const HeadingFix& fix, const Pose2& robot, double period);

/// Distance of all innovations together.
struct JointDistance {
  double squares = 0;  ///< v' S^-1 v, chi-square with `rows` degrees of freedom
  double log_det = 0;  ///< ln |S|
};
/// Returns the joint distance for a pose covariance p, which correlates the innovations and may be
/// singular.
JointDistance joint_distance(const JointEvidence& evidence, const Eigen::Matrix3d& p);

/// Returns the estimate after a Kalman update by all pairings at once.
PoseEstimate update_pose(const PoseEstimate& estimate, const JointEvidence& evidence);

}  // namespace waymark::localization
