// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Ground straight below a camera, by the tie points near its nadir; z is up.
struct GroundBelow {
  double height = 0;      ///< of a plane through the points at the nadir
  double sd = 0;          ///< of `height`: the spread of the points about the plane
  std::size_t point = 0;  ///< the nearest tie point, index into `Reconstruction::points`
};

/// Samples the ground below an image with a pose: a robust plane through the 12 tie points of its component
/// that are nearest to the nadir in plan. `std::nullopt` for fewer than 6 points, and where the nearest is
/// farther from the nadir than a fifth of the height above it.
std::optional<GroundBelow> ground_below(const Reconstruction& scene, std::size_t image);

}  // namespace waymark::pipeline
