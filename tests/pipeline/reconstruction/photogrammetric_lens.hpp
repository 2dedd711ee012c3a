// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/lens_model.hpp"
namespace waymark::test {

/// Lens of the Damped Bundle Adjustment Toolbox's model 3 (Boerlin et al. 2019): the mark, not the point, is
/// corrected for the distortion. Parameters f, px, py (mm), aspect (off unit), K1, K2, K3, P1, P2 (mm).
class PhotogrammetricLens final : public pipeline::LensModel {
 public:
  PhotogrammetricLens(Eigen::VectorXd start, double pixel_size) : start_(start), pixel_size_(pixel_size) {}

  const std::vector<std::string>& names() const override;
  Eigen::VectorXd parameters(const Camera&) const override { return start_; }
  Camera with_parameters(const Camera& camera, const Eigen::VectorXd& parameters) const override;
  bool residual(const Eigen::Ref<const Eigen::VectorXd>& parameters, const Eigen::Vector3d& point,
                const Eigen::Vector2d& mark, Residual& out) const override;

  /// Returns the mark corrected for distortion, of the pinhole camera with_parameters().
  Eigen::Vector2d corrected(const Eigen::VectorXd& parameters, const Eigen::Vector2d& mark) const;

 private:
  Eigen::VectorXd start_;
  double pixel_size_;
};

}  // namespace waymark::test
