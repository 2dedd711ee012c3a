// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Tie points in two parts.
struct SplitPoints {
  std::vector<TiePoint> kept = {}, left_out = {};
};

/// Leaves out every fifth point, chosen by its first mark: the order of images and points does not matter.
SplitPoints split_points(const Reconstruction& scene);

/// Returns the typical residual of points that the adjustment did not see, triangulated with its poses and
/// lenses, in standard deviations: sqrt(exp(mean log(1 + r^2)) - 1), so that outliers do not decide.
double left_out_residual(const Reconstruction& scene, const std::vector<TiePoint>& left_out);

}  // namespace waymark::pipeline
