// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/Eigenvalues>

namespace waymark::inline core {

SymmetricEigen3 symmetric_eigen(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace waymark::inline core
