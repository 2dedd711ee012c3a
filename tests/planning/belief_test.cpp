// SPDX-License-Identifier: Apache-2.0
#include "planning/belief.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "localization/body_motion.hpp"

namespace waymark::test {
namespace {

using namespace planning;
using localization::OdometryNoise;

Eigen::Matrix3d random_covariance(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Matrix3d m;
  for (double& v : m.reshaped()) v = normal(random);
  return m * m.transpose() + 0.01 * Eigen::Matrix3d::Identity();
}

TEST(Belief, UpdateIsTheInverseOfSummedInformation) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d p = random_covariance(random), j = random_covariance(random);
    const Eigen::Matrix3d expected = (p.inverse() + j).inverse();
    EXPECT_TRUE(update(symmetric(p), symmetric(j)).matrix().isApprox(expected, 1e-9));
  }
}

TEST(Belief, TwoHalfStepsAreOneStep) {
  std::mt19937 random(2);
  const OdometryNoise noise;
  for (int i = 0; i < 20; ++i) {
    const Symmetric3 p = symmetric(random_covariance(random));
    const double c = std::cos(i), s = std::sin(i);
    const Symmetric3 whole = predict(p, {3, c, s, 0.4}, noise);
    const Symmetric3 half = predict(predict(p, {1.5, c, s, 0.4}, noise), {1.5, c, s, 0}, noise);
    EXPECT_TRUE(half.matrix().isApprox(whole.matrix(), 1e-12));
  }
}

TEST(Belief, PredictsAsTheLocalizersDo) {
  // Many short steps of the localizers' odometry model, which share the noise.
  OdometryNoise noise;
  noise.position_per_second = noise.yaw_per_second = 0;
  const localization::BodyMotion step = localization::twist_motion(0.01, 0, 0, 1, noise);
  localization::PoseEstimate estimate{{0, 0, 0.7}, Eigen::Vector3d(0.01, 0.02, 0.001).asDiagonal()};
  const Symmetric3 start = symmetric(estimate.covariance);
  for (int i = 0; i < 400; ++i) estimate = localization::predict_pose(estimate, step);
  const Symmetric3 whole = predict(start, {4, std::cos(0.7), std::sin(0.7), 0}, noise);
  EXPECT_TRUE(whole.matrix().isApprox(estimate.covariance, 1e-2));
}

TEST(Belief, SmallerCovariancesAreExceeded) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d a = random_covariance(random), b = random_covariance(random);
    const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(1.2 * a - b).eigenvalues()[0];
    if (std::abs(smallest) < 1e-9) continue;
    EXPECT_EQ(exceeds(symmetric(a), symmetric(b), 1.2), smallest > 0);
  }
}

}  // namespace
}  // namespace waymark::test
