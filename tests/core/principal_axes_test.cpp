// SPDX-License-Identifier: Apache-2.0
#include "core/principal_axes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>

#include "core/random.hpp"

namespace waymark::test {
namespace {

TEST(PrincipalAxes, AgreeWithTheGeneralSolver) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10, random.uniform(-8, 8)), ratio = std::pow(10, random.uniform(-9, 0));
    const Eigen::Rotation2Dd turn(random.uniform(-4, 4));
    const Eigen::Matrix2d r = turn.toRotationMatrix();
    const Eigen::Matrix2d m = r * Eigen::Vector2d(size, size * ratio).asDiagonal() * r.transpose();
    const PrincipalAxes axes = principal_axes(m);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> twin(m);
    EXPECT_NEAR(axes.major, twin.eigenvalues()[1], 1e-14 * size);
    EXPECT_NEAR(axes.minor, twin.eigenvalues()[0], 1e-14 * size);
    EXPECT_GT(axes.angle, -std::numbers::pi / 2);
    EXPECT_LE(axes.angle, std::numbers::pi / 2);
    const Eigen::Matrix2d again = axes.major * axes.major_direction() * axes.major_direction().transpose() +
                                  axes.minor * axes.minor_direction() * axes.minor_direction().transpose();
    EXPECT_LT((again - m).norm(), 1e-14 * size);
  }
}

TEST(PrincipalAxes, HandleDegenerateMatrices) {
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Zero()).major, 0);
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Identity()).angle, 0);
  Eigen::Matrix2d tall;
  tall << 1, -0.0, -0.0, 4;
  EXPECT_DOUBLE_EQ(principal_axes(tall).angle, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(principal_axes(tall).major, 4);
  Eigen::Matrix2d skew;  // only the symmetric part counts
  skew << 3, 2, 0, 3;
  EXPECT_DOUBLE_EQ(principal_axes(skew).major, 4);
  skew(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(principal_axes(skew).major));
}

}  // namespace
}  // namespace waymark::test
