// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "pipeline/reconstruction/adjustment/place_on_dem.hpp"
namespace waymark::workflows {

/// Parts of a reconstruction without a frame that are searched in a DEM or a map image.
struct FreeRelief {
  std::vector<Eigen::Vector3d> points = {}, centres = {};  ///< tie points, cameras
  std::optional<Eigen::Vector3d> up = {};                  ///< by the gimbals, if they agree
  std::size_t component = 0;                               ///< of the images with a pose

  /// Returns what place_on_dem() and level_relief() take; it refers to this value.
  pipeline::ReliefToPlace view() const { return {.points = points, .centres = centres, .up = up}; }
};

/// Returns the positioned tie points, the centres of the cameras and the upward direction of a
/// reconstruction.
FreeRelief free_relief(const pipeline::Reconstruction& scene, const pipeline::Observations& seen);

/// Returns the positions of the tie points that have one.
std::vector<Eigen::Vector3d> tie_positions(const pipeline::Reconstruction& scene);

}  // namespace waymark::workflows
