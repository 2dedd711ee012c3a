// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "geo/similarity.hpp"
#include "pipeline/reconstruction/adjustment/place_on_dem.hpp"
namespace waymark::pipeline {

inline constexpr int kReliefBins = 16;              ///< across the relief
inline constexpr std::size_t kMinReliefNodes = 40;  ///< bins with points; fewer show no relief

/// Points levelled, about the origin, with an extent of 1.
struct LevelRelief {
  Similarity level_from_frame = {};
  std::vector<Eigen::Vector3d> nodes = {};  ///< one per bin: the point of median height
  double relief = 0;                        ///< of the nodes about their plane, root mean square
};

/// Levels points by the given upward direction, else by their plane, above which the cameras lie. The
/// outermost hundredth is left out. `relief` is 0 with fewer than `kMinReliefNodes` nodes.
LevelRelief level_relief(const ReliefToPlace& relief);

/// Returns a, b, c of the plane z = a x + b y + c by least squares, repeated twice without the worst tenth.
Eigen::Vector3d fitted_plane(std::vector<Eigen::Vector3d> points);

}  // namespace waymark::pipeline
