// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/pose_uncertainty.hpp"

#include <Eigen/LU>
#include <cmath>

namespace waymark::pipeline {
namespace {

double* lens_parameter(Camera& camera, const std::string& name) {
  if (name == "cx") return &camera.cx;
  if (name == "cy") return &camera.cy;
  const bool fisheye = camera.lens == Camera::Lens::fisheye;
  if (name == "k1") return &camera.distortion[0];
  if (name == "k2") return &camera.distortion[1];
  if (name == "p1" && !fisheye) return &camera.distortion[2];
  if (name == "p2" && !fisheye) return &camera.distortion[3];
  if (name == "k3") return &camera.distortion[fisheye ? 2 : 4];
  return nullptr;
}

// Derivatives of the pixel by the lens parameters, 2 x n; central differences.
Eigen::MatrixXd lens_derivatives(const SurfaceView& view, const Eigen::Vector3d& point) {
  const auto& names = view.lens.parameters;
  Eigen::MatrixXd by_lens = Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(names.size()));
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::optional<Eigen::Vector2d> seen[2];
    const double step = names[n] == "f" || names[n] == "cx" || names[n] == "cy" ? 0.1 : 1e-5;
    for (int side = 0; side < 2; ++side) {
      PosedCamera moved = view.view;
      const double by = side == 0 ? -step : step;
      if (names[n] == "f")
        moved.camera.fx += by, moved.camera.fy += by;
      else if (double* value = lens_parameter(moved.camera, names[n]))
        *value += by;
      seen[side] = project(moved, {point});
    }
    if (seen[0] && seen[1]) by_lens.col(static_cast<Eigen::Index>(n)) = (*seen[1] - *seen[0]) / (2 * step);
  }
  return by_lens;
}

std::optional<Eigen::Matrix<double, 2, 3>> point_derivatives(const PosedCamera& view,
                                                             const Eigen::Vector3d& point) {
  const double step = 1e-5 * (view.centre().xyz - point).norm();
  Eigen::Matrix<double, 2, 3> by_point;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d move = step * Eigen::Vector3d::Unit(axis);
    const auto a = project(view, {point - move}), b = project(view, {point + move});
    if (!a || !b) return std::nullopt;
    by_point.col(axis) = (*b - *a) / (2 * step);
  }
  return by_point;
}

Eigen::Matrix3d cross_product_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

std::optional<Eigen::Matrix3d> pose_uncertainty(const std::vector<SurfaceView>& views,
                                                std::span<const std::size_t> used,
                                                const Eigen::Vector3d& point) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), poses = Eigen::Matrix3d::Zero();
  Eigen::MatrixXd lenses;
  const LensCovariance* lens = nullptr;
  for (const std::size_t v : used) {
    const SurfaceView& view = views[v];
    const auto by_point = point_derivatives(view.view, point);
    if (!by_point) continue;
    normal += by_point->transpose() * *by_point;
    // The rotation acts in the camera's axes: p = R^T (X - C) becomes p + p x angle.
    const Eigen::Isometry3d& pose = view.view.grid_from_camera.transform;
    const Eigen::Vector3d in_camera = pose.linear().transpose() * (point - pose.translation());
    Eigen::Matrix<double, 2, 6> by_pose;
    by_pose << *by_point * pose.linear() * cross_product_matrix(in_camera), -*by_point;
    const Eigen::Matrix<double, 3, 6> effect = by_point->transpose() * by_pose;
    poses += effect * view.view.covariance * effect.transpose();
    if (view.lens.parameters.empty()) continue;
    if (!lens) lens = &view.lens, lenses = Eigen::MatrixXd::Zero(3, view.lens.covariance.cols());
    if (view.lens.parameters == lens->parameters)
      lenses += by_point->transpose() * lens_derivatives(view, point);
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(normal);
  if (!solver.isInvertible()) return std::nullopt;
  Eigen::Matrix3d sum = poses;
  if (lens) sum += lenses * lens->covariance * lenses.transpose();
  const Eigen::Matrix3d inverse = solver.inverse();
  return inverse * sum * inverse;
}

}  // namespace waymark::pipeline
