// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/global/skyline.hpp"
#include "localization/global/terrain_grid.hpp"
namespace waymark::localization {

/// Horizon in one direction: tangent of its elevation, and its distance, m. `far` 0: no terrain.
struct HorizonEdge {
  float rise = -1e9F, far = 0;
};

/// Returns the horizon in sectors of equal width, the first from azimuth 0 (east) towards y (north). Each
/// holds the highest terrain, sampled in blocks about as wide as the sector (cone tracing in a max
/// pyramid). `nearest` m: terrain nearer than that is ignored. `eye`: m above the datum. Some microseconds
/// per sector.
std::vector<HorizonEdge> horizon_ring(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye,
                                      double nearest, int sectors, const SkylineOptions& options);

/// Returns the horizon in one direction, by a ray in steps of about a cell through bilinear heights.
HorizonEdge horizon_at(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye, double azimuth,
                       const SkylineOptions& options);

}  // namespace waymark::localization
