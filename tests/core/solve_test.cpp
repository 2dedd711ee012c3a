// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

namespace waymark::test {
namespace {

Eigen::MatrixXd random_covariance(Eigen::Index size) {
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(size, size);
  return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size);
}

TEST(Solve, SolvesSymmetricSystems) {
  for (int round = 0; round < 20; ++round) {
    const Eigen::Matrix3d three = random_covariance(3);
    const Eigen::Vector3d right = Eigen::Vector3d::Random();
    EXPECT_LT((three * solve_symmetric(three, right) - right).norm(), 1e-10);
    const Eigen::Matrix<double, 6, 6> six = random_covariance(6);
    EXPECT_LT((six * inverse_by_lu(six) - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-9);
    const Eigen::MatrixXd any = random_covariance(9);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(9);
    EXPECT_LT((any * solve_symmetric(any, b) - b).norm(), 1e-9);
    const Cholesky root(any);
    ASSERT_TRUE(root.positive_definite());
    EXPECT_LT((any * root.solve(b) - b).norm(), 1e-9);
    EXPECT_LT((any * root.solve(any) - any).norm(), 1e-9);
  }
}

TEST(Solve, CholeskySaysThatAMatrixIsNotPositiveDefinite) {
  EXPECT_FALSE(Cholesky(-Eigen::MatrixXd::Identity(4, 4)).positive_definite());
}

TEST(Solve, ResidualsOfLeastSquaresAreNormalToTheColumns) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(30, 4);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(30);
  EXPECT_LT((a.transpose() * (a * solve_least_squares(a, b) - b)).norm(), 1e-10);
}

TEST(Solve, DecompositionsGiveTheMatrixBack) {
  const Eigen::Matrix3d m = Eigen::Matrix3d::Random();
  const SingularValues3 svd = singular_values(m);
  EXPECT_LT((svd.u * svd.values.asDiagonal() * svd.v.transpose() - m).norm(), 1e-12);
  EXPECT_GE(svd.values[0], svd.values[1]);
  EXPECT_GE(svd.values[1], svd.values[2]);
  const Eigen::Matrix3d s = random_covariance(3);
  const SymmetricEigen3 eigen = symmetric_eigen(s);
  EXPECT_LT((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose() - s).norm(), 1e-12);
  EXPECT_LE(eigen.values[0], eigen.values[1]);
}

TEST(Solve, RotationTurnsOneDirectionIntoTheOther) {
  const Eigen::Vector3d from(1, 2, 3), to(-2, 0.5, 1);
  const Eigen::Matrix3d turn = rotation_between(from, to);
  EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-14);
  EXPECT_NEAR(turn.determinant(), 1, 1e-14);
}

TEST(Solve, RotationVectorsTurnAboutTheirDirection) {
  const Eigen::Matrix3d quarter = rotation_by({0, 0, std::numbers::pi / 2});
  EXPECT_LT((quarter * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  const Eigen::Vector3d vector(0.3, -0.2, 0.5);
  EXPECT_LT((rotation_by(vector) * vector - vector).norm(), 1e-15);
  EXPECT_LT((rotation_by(vector) * rotation_by(-vector) - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_EQ(rotation_by(Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace waymark::test
