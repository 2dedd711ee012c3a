// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include "pipeline/reconstruction/surface/surface_view.hpp"
namespace waymark::pipeline {

/// Returns the covariance that errors of poses and lenses give to a point intersected from some views, grid
/// frame, square metres. Errors of different images are independent, those of one lens are common.
/// `std::nullopt` if the views do not determine the point.
std::optional<Eigen::Matrix3d> pose_uncertainty(const std::vector<SurfaceView>& views,
                                                std::span<const std::size_t> used,
                                                const Eigen::Vector3d& point);

}  // namespace waymark::pipeline
