// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "exporters/raster/cog_stream.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

struct RasterTiles {
  std::int64_t tile_cells = 512;
  int threads = 0;    ///< 0: one per processor
  std::string stage;  ///< of the progress
};

/// Computes the bands of a tile; calls `done` with the fraction of it that is computed, 0 to 1, which may
/// throw to end the work.
using ComputeTile =
    std::function<std::vector<Grid<float>>(const Window& tile, const std::function<void(double)>& done)>;

/// Computes the bands of all tiles of a grid and writes them in the order of the tiles: row by row from the
/// north. Some tiles per thread are in memory. `compute` is called from several threads, `use` in order.
void write_tiles(const GridGeometry& grid, const RasterTiles& how, const ComputeTile& compute,
                 const std::function<void(const std::vector<Grid<float>>&)>& use, exporters::CogStream& file,
                 const Callbacks& callbacks);

}  // namespace waymark::workflows
