// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <stdexcept>

#include "core/random.hpp"
#include "localization/filters/measurement.hpp"
#include "localization/motion_model.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::HasSubstr;

Pose2 any_pose(Random& random) {
  return {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3.1, 3.1)};
}

Eigen::Vector3d off(const Pose2& a, const Pose2& b) {
  return {a.x - b.x, a.y - b.y, wrap_angle(a.yaw - b.yaw)};
}

TEST(Pose2, InverseUndoes) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 p = any_pose(random);
    EXPECT_LT(off(inverse(p) * p, {}).norm(), 1e-12);
  }
}

TEST(Motion, JacobiansAreThoseOfDifferences) {
  Random random(2);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose = any_pose(random), step = any_pose(random);
    const MotionJacobians j = motion_jacobians(pose, step);
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d[k] = kStep;
      const Eigen::Vector3d by_pose =
          off(pose_of(pose.vector() + d) * step, pose_of(pose.vector() - d) * step) / (2 * kStep);
      const Eigen::Vector3d by_step =
          off(pose * pose_of(step.vector() + d), pose * pose_of(step.vector() - d)) / (2 * kStep);
      EXPECT_LT((by_pose - j.by_pose.col(k)).norm(), 1e-7);
      EXPECT_LT((by_step - j.by_step.col(k)).norm(), 1e-7);
    }
  }
}

TEST(Measurement, JacobiansAreThoseOfDifferences) {
  Random random(3);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose = any_pose(random), mount{1.2, -0.4, 0.7};
    const Eigen::Vector2d landmark(random.uniform(-20, 20), random.uniform(-20, 20));
    const ExpectedSighting e = expect(pose, mount, landmark);
    if (e.value[0] < 0.5) continue;
    const auto difference = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return Eigen::Vector2d(a[0] - b[0], wrap_angle(a[1] - b[1]));
    };
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d[k] = kStep;
      const Eigen::Vector2d by = difference(expect(pose_of(pose.vector() + d), mount, landmark).value,
                                            expect(pose_of(pose.vector() - d), mount, landmark).value);
      EXPECT_LT((by / (2 * kStep) - e.by_pose.col(k)).norm(), 1e-6);
      if (k == 2) continue;
      const Eigen::Vector2d shift = d.head<2>();
      const Eigen::Vector2d by_landmark = difference(expect(pose, mount, landmark + shift).value,
                                                     expect(pose, mount, landmark - shift).value);
      EXPECT_LT((by_landmark / (2 * kStep) - e.by_landmark.col(k)).norm(), 1e-6);
    }
  }
}

TEST(Motion, ManySmallStepsAreOneArc) {
  const OdometryNoise noise;
  const BodyMotion once = twist_motion(1, 0.2, 0.5, 2, noise);
  BodyMotion often;
  for (int i = 0; i < 1000; ++i) often = compose(often, twist_motion(1, 0.2, 0.5, 0.002, noise));
  EXPECT_LT(off(once.step, often.step).norm(), 1e-9);
  EXPECT_NEAR(once.covariance(2, 2), often.covariance(2, 2), 1e-9) << "noise must not depend on the rate";
}

TEST(Motion, CovarianceIsThatOfSamples) {
  Random random(4);
  const OdometryNoise noise{.along_per_metre = 1e-3, .across_per_metre = 1e-3, .yaw_per_metre = 1e-3};
  const BodyMotion step = twist_motion(1, 0, 0.3, 1, noise);
  PoseEstimate e{{1, 2, 0.5}, Eigen::Vector3d(0.01, 0.02, 0.001).asDiagonal()};
  const Eigen::Matrix3d a = square_root(e.covariance), b = square_root(step.covariance);
  const auto draw = [&] { return Eigen::Vector3d(random.normal(), random.normal(), random.normal()); };
  const PoseEstimate predicted = predict_pose(e, step);
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 p = pose_of(e.pose.vector() + a * draw()) * pose_of(step.step.vector() + b * draw());
    sampled += off(p, predicted.pose) * off(p, predicted.pose).transpose() / kDraws;
  }
  // 20,000 draws know a variance to 1 %; second order terms add a little.
  EXPECT_LT((sampled - predicted.covariance).norm(), 0.04 * predicted.covariance.norm());
}

TEST(Motion, CarDrivesACircleAboutItsRearAxle) {
  Ackermann car;
  car.encoder_offset = 0;
  const double steering = std::atan(2.83 / 10);  // radius 10 m
  Pose2 pose;
  for (int i = 0; i < 100; ++i) pose = pose * ackermann_motion(car, 1, steering, 0.1, {}).step;
  EXPECT_NEAR((pose.at() - Eigen::Vector2d(0, 10)).norm(), 10, 1e-9);
  EXPECT_NEAR(pose.yaw, 1, 1e-9);  // 10 m along it
}

TEST(Motion, RefusesWhatIsNoMotion) {
  EXPECT_THROW(twist_motion(NAN, 0, 0, 1, {}), std::invalid_argument);
  try {
    twist_motion(1, 0, 0, -1, {});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("time runs backwards"));
  }
  EXPECT_THROW(ackermann_motion({}, 1, 25, 1, {}), std::invalid_argument) << "degrees";
}

TEST(SquareRoot, OfSemidefiniteCovariances) {
  Eigen::Matrix3d flat = Eigen::Vector3d(1, 0, 0.25).asDiagonal();
  flat(0, 2) = flat(2, 0) = 0.5;  // rank 1
  const Eigen::Matrix3d root = square_root(flat);
  EXPECT_LT((root * root.transpose() - flat).norm(), 1e-12);
}

}  // namespace
}  // namespace waymark::test
