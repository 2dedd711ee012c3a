// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/LU>

namespace waymark::inline core {

Eigen::Matrix<double, 6, 6> inverse_by_lu(const Eigen::Matrix<double, 6, 6>& matrix) {
  return matrix.inverse();
}

}  // namespace waymark::inline core
