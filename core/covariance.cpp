// SPDX-License-Identifier: Apache-2.0
#include "core/covariance.hpp"

#include <Eigen/Eigenvalues>

namespace waymark::inline core {

bool is_covariance(const Eigen::Matrix2d& matrix) {
  const double trace = matrix(0, 0) + matrix(1, 1);
  const double determinant = matrix(0, 0) * matrix(1, 1) - matrix(1, 0) * matrix(0, 1);
  return matrix.allFinite() && matrix(0, 0) >= 0 && matrix(1, 1) >= 0 && determinant >= -1e-9 * trace * trace;
}

bool is_covariance(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite()) return false;
  if (matrix(0, 1) == 0 && matrix(0, 2) == 0 && matrix(1, 2) == 0) return matrix.diagonal().minCoeff() >= 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -1e-12 * solver.eigenvalues().maxCoeff();
}

Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric) {
  if (is_covariance(symmetric)) return symmetric;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric);
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

double largest_sd(const Eigen::Matrix2d& c) {
  return std::sqrt(std::max(0.0, (c(0, 0) + c(1, 1)) / 2 + std::hypot((c(0, 0) - c(1, 1)) / 2, c(0, 1))));
}

}  // namespace waymark::inline core
