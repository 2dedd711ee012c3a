// SPDX-License-Identifier: Apache-2.0
// Eigen's decompositions behind plain functions: each is compiled once in place of in every file that solves,
// which takes seconds for each. The results are Eigen's.
#pragma once
#include <Eigen/Core>
namespace waymark::inline core {

/// Returns the solution of `matrix` x = `right` for a symmetric semidefinite matrix by its LDL' factors.
/// Sizes: 3, 6 and Eigen::Dynamic.
template <int N>
Eigen::Vector<double, N> solve_symmetric(const Eigen::Matrix<double, N, N>& matrix,
                                         const Eigen::Vector<double, N>& right);

/// Returns the inverse by an LU decomposition with partial pivoting; not finite if the matrix is singular.
Eigen::Matrix<double, 6, 6> inverse_by_lu(const Eigen::Matrix<double, 6, 6>& matrix);

/// Returns the least squares solution of `matrix` x = `right` by a QR decomposition with pivoting of columns.
Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Singular values in decreasing order: matrix = u diag(values) v'.
struct SingularValues3 {
  Eigen::Matrix3d u, v;
  Eigen::Vector3d values;
};

/// Returns the singular value decomposition by two-sided Jacobi rotations.
SingularValues3 singular_values(const Eigen::Matrix3d& matrix);

/// Eigenvalues of a symmetric matrix in increasing order, with unit eigenvectors as columns.
struct SymmetricEigen3 {
  Eigen::Vector3d values;
  Eigen::Matrix3d vectors;
};

/// Returns the eigenvalues of a symmetric matrix; reads its lower triangle.
SymmetricEigen3 symmetric_eigen(const Eigen::Matrix3d& matrix);

/// Returns the smallest rotation that turns the direction `from` into the direction `to`; neither may be
/// zero.
Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Returns the rotation about the direction of a rotation vector by its length, radians; zero: none.
Eigen::Matrix3d rotation_by(const Eigen::Vector3d& rotation_vector);

/// Lower Cholesky factor of a symmetric matrix.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& matrix);

  /// Returns whether the matrix was positive definite; without it no solution holds.
  bool positive_definite() const { return positive_definite_; }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  Eigen::MatrixXd factor_;
  bool positive_definite_ = false;
};

}  // namespace waymark::inline core
