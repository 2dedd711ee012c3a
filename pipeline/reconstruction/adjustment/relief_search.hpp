// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
namespace waymark::pipeline {

/// Trial of a level relief in a DEM.
struct ReliefTrial {
  double x = 0, y = 0;   ///< map position of the origin of the relief, metres
  double yaw = 0;        ///< radians, counterclockwise
  double scale = 1;      ///< metres per unit
  double agreement = 0;  ///< 2 ab / (aa + bb) of the heights about their planes; 1: equal
};

/// Sizes that a search tries.
struct ReliefSearch {
  double smallest = 0, largest = 0;  ///< extent of the relief in the DEM, metres
};

/// Returns the trials that agree best, the best first, at most `count`. `nodes` are level points about the
/// origin with an extent of 1; each is compared with the nearest cell of a DEM whose cells are a twelfth of
/// the relief.
std::vector<ReliefTrial> search_relief(const std::vector<Eigen::Vector3d>& nodes, const CoarseHeights& dem,
                                       const ReliefSearch& search, std::size_t count);

}  // namespace waymark::pipeline
