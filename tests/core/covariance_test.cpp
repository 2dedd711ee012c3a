// SPDX-License-Identifier: Apache-2.0
#include "core/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace waymark::test {
namespace {

Eigen::Matrix2d symmetric(double xx, double yy, double xy) {
  return (Eigen::Matrix2d() << xx, xy, xy, yy).finished();
}

TEST(Covariance, VariancesAndCorrelationDecide) {
  EXPECT_TRUE(is_covariance(symmetric(1, 4, 1.9)));
  EXPECT_TRUE(is_covariance(symmetric(1, 4, -2))) << "fully correlated";
  EXPECT_TRUE(is_covariance(symmetric(0, 0, 0))) << "exactly known";
  EXPECT_FALSE(is_covariance(symmetric(1, 4, 2.1)));
  EXPECT_FALSE(is_covariance(symmetric(-1, -4, 0))) << "its determinant is positive";
  EXPECT_FALSE(is_covariance(symmetric(0, 1, 1e-3)));
}

TEST(Covariance, RoundingOfAFullCorrelationIsAllowed) {
  for (const double angle : {0.1, 0.7, 1.3, 2.9})
    for (const double variance : {1e-6, 1.0, 1e8}) {
      const double c = std::cos(angle), s = std::sin(angle);
      EXPECT_TRUE(is_covariance(symmetric(variance * c * c, variance * s * s, variance * c * s))) << angle;
    }
}

TEST(Covariance, UnknownNumbersAreNone) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(is_covariance(symmetric(bad, 1, 0)));
    EXPECT_FALSE(is_covariance(symmetric(1, 1, bad)));
  }
}

TEST(Covariance, ThreeDimensionsAsTwo) {
  Eigen::Matrix3d m = Eigen::Vector3d(1, 4, 9).asDiagonal();
  EXPECT_TRUE(is_covariance(m));
  m(0, 2) = m(2, 0) = 2.9;
  EXPECT_TRUE(is_covariance(m));
  m(0, 2) = m(2, 0) = 3.1;
  EXPECT_FALSE(is_covariance(m));
  m(0, 2) = m(2, 0) = std::nan("");
  EXPECT_FALSE(is_covariance(m));
  EXPECT_FALSE(is_covariance(Eigen::Matrix3d(Eigen::Vector3d(1, -1, 1).asDiagonal())));
  const Eigen::Vector3d line(1, 2, 3);
  EXPECT_TRUE(is_covariance(Eigen::Matrix3d(line * line.transpose()))) << "no width in two directions";
}

TEST(Covariance, ThePositivePartLacksTheNegativeEigenvaluesAlone) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto turned = [&](double a, double b, double c) -> Eigen::Matrix3d {
    return turn * Eigen::Vector3d(a, b, c).asDiagonal() * turn.transpose();
  };
  EXPECT_TRUE(positive_part(turned(4, -1, 9)).isApprox(turned(4, 0, 9), 1e-12));
  const Eigen::Matrix3d sound = turned(4, 1, 9);
  EXPECT_EQ(positive_part(sound), sound);
}

}  // namespace
}  // namespace waymark::test
