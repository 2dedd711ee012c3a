// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
namespace waymark {

/// Eigenvalues and eigenvectors of a symmetric 2x2 matrix (of a covariance, of the second moments of a blob).
struct PrincipalAxes {
  double major = 0, minor = 0;  ///< eigenvalues, the larger first
  double angle = 0;             ///< of the major axis from x towards y, radians, (-pi/2, pi/2]

  Eigen::Vector2d along() const;   ///< unit vector of the major axis
  Eigen::Vector2d across() const;  ///< unit vector of the minor axis: along() turned by a right angle
};

/// In closed form, so that no file that draws an ellipse compiles a general eigensolver (a Jacobi rotation,
/// Golub and Van Loan 2013, 8.5.2). Of `matrix` only the symmetric part counts. Exact to a few ulp of the
/// larger eigenvalue; equal eigenvalues give angle 0. NaN in, NaN out.
PrincipalAxes principal_axes(const Eigen::Matrix2d& matrix);

}  // namespace waymark
