// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/dem_handle.hpp"
#include "geo/terrain.hpp"
namespace waymark {

/// Cells of a DEM as terrain in the grid frame: metres. The window may reach outside the DEM.
/// Throws Error for a DEM in degrees, telling how to warp it, and for one whose rows run north.
Terrain terrain_for(const DemSource& dem, const Window& window);

/// The whole DEM. The last one made is kept, since the units of all images ask for the same; 8 bytes per cell
/// or so. Throws Error above `most_cells` cells, naming the size.
Terrain terrain_of(const DemHandle& dem, std::int64_t most_cells = 400'000'000);

}  // namespace waymark
