// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/SVD>

namespace waymark::inline core {

SingularValues3 singular_values(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

}  // namespace waymark::inline core
