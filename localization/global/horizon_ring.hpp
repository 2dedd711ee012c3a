// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/global/skyline.hpp"
#include "localization/global/terrain_grid.hpp"
namespace waymark {

/// Where the ground ends in one direction: tangent of its elevation, and how far it is. `far` 0: no ground.
struct HorizonEdge {
  float rise = -1e9F, far = 0;
};

/// The horizon in sectors of equal width, the first from azimuth 0 (east) towards y (north): in each the
/// highest of the ground, looked at in blocks about as wide as the sector (cone tracing in a max pyramid).
/// `nearest` m: ground nearer than that hides nothing. `eye`: m above the datum. Some microseconds per
/// sector.
std::vector<HorizonEdge> horizon_ring(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye,
                                      double nearest, int sectors, const SkylineOptions& options);

/// The horizon in one direction, by a ray in steps of about a cell, heights bilinear.
HorizonEdge horizon_at(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye, double azimuth,
                       const SkylineOptions& options);

}  // namespace waymark
