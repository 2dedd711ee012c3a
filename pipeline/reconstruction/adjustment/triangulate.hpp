// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>
#include "geo/camera.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Point seen from known cameras.
struct TriangulatedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< by the marks alone: poses count as exact
  double angle = 0;                                      ///< largest between two rays, radians
  double rms = 0;                                        ///< of the residuals, in standard deviations
};

/// Mark with its camera.
struct PosedMark {
  const Camera* camera = nullptr;
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sd = 1;  ///< pixels
};

/// Returns the point whose projections are closest to the marks (Gauss-Newton from the midpoint of the rays).
/// `std::nullopt` for fewer than two rays, parallel rays, and points behind a camera.
std::optional<TriangulatedPoint> triangulate(std::span<const PosedMark> marks);

/// Triangulates from the marks in images with a pose.
std::optional<TriangulatedPoint> triangulate(const Reconstruction& scene, const std::vector<Mark>& marks);

}  // namespace waymark::pipeline
