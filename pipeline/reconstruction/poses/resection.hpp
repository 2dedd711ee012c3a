// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>
#include "geo/camera.hpp"
namespace waymark::pipeline {

/// Point of the scene and where the image shows it.
struct ImagedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

struct ResectionSettings {
  double threshold = 4;  ///< pixels
  int max_samples = 2000;
  std::uint64_t seed = 1;
};

struct Resection {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  std::vector<std::size_t> inliers = {};
};

/// Estimates the pose of an image from known points: AP3P (Ke & Roumeliotis 2017) in RANSAC, then
/// Gauss-Newton on the inliers. `std::nullopt` for fewer than 6 points that agree.
std::optional<Resection> resect(const Camera& camera, std::span<const ImagedPoint> points,
                                const ResectionSettings& settings);

}  // namespace waymark::pipeline
