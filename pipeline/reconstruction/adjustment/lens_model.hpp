// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>
#include "geo/camera.hpp"
namespace waymark::pipeline {

/// Lens as a function of parameters, for the adjustment.
class LensModel {
 public:
  static constexpr int kMaxParameters = 12;
  /// Derivative of a mark's residual by the parameters of its lens.
  using LensJacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor, 2, kMaxParameters>;

  /// Residual of a mark (predicted minus measured, pixels) with its derivatives.
  struct Residual {
    Eigen::Vector2d value = Eigen::Vector2d::Zero();
    LensJacobian by_lens = {};
    Eigen::Matrix<double, 2, 3> by_point = {};  ///< by the point in the frame of the camera
  };

  virtual ~LensModel() = default;
  /// Returns the names of the parameters, at most `kMaxParameters`.
  virtual const std::vector<std::string>& names() const = 0;
  /// Returns the parameters of a camera, in the order of names().
  virtual Eigen::VectorXd parameters(const Camera& camera) const = 0;
  /// Returns the camera with other parameters.
  virtual Camera with_parameters(const Camera& camera, const Eigen::VectorXd& parameters) const = 0;
  /// Computes the residual of a mark. Returns false for points at or behind the camera's plane.
  virtual bool residual(const Eigen::Ref<const Eigen::VectorXd>& parameters, const Eigen::Vector3d& point,
                        const Eigen::Vector2d& mark, Residual& out) const = 0;
};

/// Returns the model of a camera's lens. Brown: f, aspect (fy / fx), cx, cy, k1, k2, k3, p1, p2. Fisheye: f,
/// aspect, cx, cy, k1, k2, k3, k4. Skew and the denominator of Brown's radial term stay as they are.
std::shared_ptr<const LensModel> lens_model(const Camera& camera);

}  // namespace waymark::pipeline
