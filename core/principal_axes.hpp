// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
namespace waymark::inline core {

/// Eigenvalues and eigenvectors of a symmetric 2x2 matrix, e.g. of a covariance or of second moments.
struct PrincipalAxes {
  double major = 0, minor = 0;  ///< eigenvalues, the larger first
  double angle = 0;             ///< of the major axis from x towards y, radians, (-pi/2, pi/2]

  Eigen::Vector2d major_direction() const;  ///< unit vector of the major axis
  Eigen::Vector2d minor_direction() const;  ///< unit vector of the minor axis, 90 deg from the major axis
};

/// Computes the principal axes of the symmetric part of `matrix` in closed form (a Jacobi rotation, Golub and
/// Van Loan 2013, 8.5.2). Accurate to a few ulp of the larger eigenvalue. Equal eigenvalues give angle 0; NaN
/// gives NaN.
PrincipalAxes principal_axes(const Eigen::Matrix2d& matrix);

}  // namespace waymark::inline core
