// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/Cholesky>

namespace waymark::inline core {

template <int N>
Eigen::Vector<double, N> solve_symmetric(const Eigen::Matrix<double, N, N>& matrix,
                                         const Eigen::Vector<double, N>& right) {
  return matrix.ldlt().solve(right);
}
template Eigen::Vector<double, 3> solve_symmetric(const Eigen::Matrix<double, 3, 3>&,
                                                  const Eigen::Vector<double, 3>&);
template Eigen::Vector<double, 6> solve_symmetric(const Eigen::Matrix<double, 6, 6>&,
                                                  const Eigen::Vector<double, 6>&);
template Eigen::Vector<double, Eigen::Dynamic> solve_symmetric(
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>&,
    const Eigen::Vector<double, Eigen::Dynamic>&);

}  // namespace waymark::inline core
