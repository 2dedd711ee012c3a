// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/joint_evidence.hpp"

#include <Eigen/LU>

namespace waymark::localization {

JointEvidence& JointEvidence::operator+=(const JointEvidence& more) {
  information += more.information;
  information_vector += more.information_vector;
  squares += more.squares;
  log_det += more.log_det;
  rows += more.rows;
  return *this;
}

JointEvidence evidence_of(const SeenLandmark& seen, const ExpectedSighting& expected,
                          const Eigen::Matrix2d& landmark_covariance, double trust) {
  const Eigen::Vector2d v = innovation(seen, expected.value);
  const Eigen::Matrix2d r =
      (sensor_noise(seen) + expected.by_landmark * landmark_covariance * expected.by_landmark.transpose()) /
      trust;
  JointEvidence e;
  if (seen.has_position()) {
    const Eigen::Matrix2d inverse = r.inverse();
    const Eigen::Matrix<double, 3, 2> weighted = expected.by_pose.transpose() * inverse;
    e.information = weighted * expected.by_pose;
    e.information_vector = weighted * v;
    e.squares = v.dot(inverse * v);
    e.log_det = std::log(r.determinant());
    e.rows = 2;
  } else {
    const int row = seen.range ? 0 : 1;
    const Eigen::Vector3d h = expected.by_pose.row(row).transpose();
    e.information = h * h.transpose() / r(row, row);
    e.information_vector = h * v[row] / r(row, row);
    e.squares = v[row] * v[row] / r(row, row);
    e.log_det = std::log(r(row, row));
    e.rows = 1;
  }
  return e;
}

JointEvidence evidence_of(const HeadingFix& fix, const Pose2& robot, double period) {
  const double v = wrap_angle(fix.yaw - robot.yaw), variance = fix.sd * fix.sd;
  JointEvidence e;
  e.information(2, 2) = 1 / variance;
  e.information_vector[2] = v / variance;
  e.squares = v * v / variance;
  e.log_det = std::log(variance / (period * period));
  e.rows = 1;
  return e;
}

// (P^-1 + L)^-1 = P (I + L P)^-1 holds for singular P too; |S| = |R| |I + L P|.
JointDistance joint_distance(const JointEvidence& evidence, const Eigen::Matrix3d& p) {
  const Eigen::Matrix3d m = Eigen::Matrix3d::Identity() + evidence.information * p;
  const double det = m.determinant();
  const double squares =
      evidence.squares - evidence.information_vector.dot(p * (m.inverse() * evidence.information_vector));
  return {std::max(0.0, squares), evidence.log_det + std::log(std::max(det, 1e-300))};
}

PoseEstimate update_pose(const PoseEstimate& estimate, const JointEvidence& evidence) {
  const Eigen::Matrix3d& p = estimate.covariance;
  const Eigen::Matrix3d m = (Eigen::Matrix3d::Identity() + evidence.information * p).inverse();
  const Eigen::Matrix3d gain = p * m;  // posterior covariance
  // Joseph form in information terms: A P A' + G L G' with A = I - G L stays symmetric and positive.
  const Eigen::Matrix3d a = Eigen::Matrix3d::Identity() - gain * evidence.information;
  const Eigen::Matrix3d after = a * p * a.transpose() + gain * evidence.information * gain.transpose();
  return {pose_of(estimate.pose.vector() + gain * evidence.information_vector),
          (after + after.transpose()) / 2};
}

}  // namespace waymark::localization
