// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include "geo/dem_source.hpp"
#include "geo/local_frame.hpp"
#include "geo/terrain.hpp"
#include "pipeline/engine/progress.hpp"
namespace waymark::workflows {

struct SightTerrainRules {
  std::int64_t max_nodes = 64'000'000;       ///< more make the spacing wider; 5.3 bytes each
  pipeline::ProgressListener progress = {};  ///< may throw to end it
};

/// Returns the heights of a DEM at nodes of the map frame, metres, for lines of sight. The nodes are half a
/// cell of the DEM apart, over the part of `area` that the DEM covers. Unknown heights stay unknown.
/// - Positions in the DEM are interpolated in blocks of 64 nodes: wrong by 1e-3 cells at most.
/// - Reads each cell about once; 10 M nodes/s/core. Threads do not change it.
/// Throws Error{input} if the DEM does not meet the area or is of another body.
Terrain sight_terrain(const DemSource& dem, const LocalFrame& frame, const Eigen::AlignedBox2d& area,
                      const SightTerrainRules& rules = {});

}  // namespace waymark::workflows
