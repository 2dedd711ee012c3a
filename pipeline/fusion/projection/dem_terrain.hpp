// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/dem_handle.hpp"
#include "geo/terrain.hpp"
namespace waymark::pipeline {

/// Throws Error for a DEM in degrees, on which images cannot be projected; the hint is a command to warp it.
void check_metric(const DemSource& dem);

/// Reads cells of a DEM as terrain in the grid frame, metres. The window may reach outside the DEM.
/// Throws Error for a DEM in degrees, with a command to warp it, and for one whose rows run north.
Terrain read_terrain(const DemSource& dem, const Window& window);

/// Returns the whole DEM as terrain; about 8 bytes per cell. The last one is cached, since all images use the
/// same.
/// Throws Error with the size above `max_cells` cells.
Terrain load_terrain(const DemHandle& dem, std::int64_t max_cells = 400'000'000);

}  // namespace waymark::pipeline
