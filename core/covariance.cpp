// SPDX-License-Identifier: Apache-2.0
#include "core/covariance.hpp"

namespace waymark::inline core {

bool is_covariance(const Eigen::Matrix2d& matrix) {
  const double trace = matrix(0, 0) + matrix(1, 1);
  const double determinant = matrix(0, 0) * matrix(1, 1) - matrix(1, 0) * matrix(0, 1);
  return matrix.allFinite() && matrix(0, 0) >= 0 && matrix(1, 1) >= 0 && determinant >= -1e-9 * trace * trace;
}

}  // namespace waymark::inline core
