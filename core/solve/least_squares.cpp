// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/QR>

namespace waymark::inline core {

Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

}  // namespace waymark::inline core
