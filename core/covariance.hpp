// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
namespace waymark::inline core {

/// Returns whether a symmetric matrix is a covariance: finite, variances not negative, correlation within
/// [-1, 1]. Rounding may make the determinant negative by 1e-9 of the squared trace.
bool is_covariance(const Eigen::Matrix2d& matrix);

}  // namespace waymark::inline core
