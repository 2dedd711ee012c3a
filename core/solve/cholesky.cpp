// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/Cholesky>

namespace waymark::inline core {

Cholesky::Cholesky(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> llt(matrix);
  positive_definite_ = llt.info() == Eigen::Success;
  factor_ = llt.matrixLLT();
}

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& right) const {
  const auto lower = factor_.triangularView<Eigen::Lower>();
  Eigen::VectorXd x = right;
  lower.solveInPlace(x);
  lower.adjoint().solveInPlace(x);
  return x;
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& right) const {
  const auto lower = factor_.triangularView<Eigen::Lower>();
  Eigen::MatrixXd x = right;
  lower.solveInPlace(x);
  lower.adjoint().solveInPlace(x);
  return x;
}

}  // namespace waymark::inline core
