// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
namespace waymark::inline core {

/// Returns whether a symmetric matrix is a covariance: finite, variances not negative, correlation within
/// [-1, 1]. Rounding may make the determinant negative by 1e-9 of the squared trace.
bool is_covariance(const Eigen::Matrix2d& matrix);
/// Returns the same of three dimensions. Rounding may make an eigenvalue negative by 1e-12 of the largest.
bool is_covariance(const Eigen::Matrix3d& matrix);

/// Returns a symmetric matrix without its negative eigenvalues: itself if it is a covariance.
Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric);

/// Returns the standard deviation along the longest axis of a covariance.
double largest_sd(const Eigen::Matrix2d& covariance);

}  // namespace waymark::inline core
