// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/raster_tiles.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "pipeline/engine/progress_meter.hpp"

namespace waymark::workflows {
namespace {

std::vector<Window> tiles_of(const GridGeometry& grid, std::int64_t size) {
  std::vector<Window> tiles;
  for (std::int64_t row = 0; row < grid.rows; row += size)
    for (std::int64_t column = 0; column < grid.columns; column += size)
      tiles.push_back({column, row, std::min(size, grid.columns - column), std::min(size, grid.rows - row)});
  return tiles;
}

}  // namespace

void write_tiles(const GridGeometry& grid, const RasterTiles& how, const ComputeTile& compute,
                 const std::function<void(const std::vector<Grid<float>>&)>& use, exporters::CogStream& file,
                 const Callbacks& callbacks) {
  const std::vector<Window> tiles = tiles_of(grid, how.tile_cells);
  tbb::task_arena arena(how.threads > 0 ? how.threads : tbb::task_arena::automatic);
  const auto batch = static_cast<std::size_t>(std::max(1, 2 * arena.max_concurrency()));
  pipeline::ProgressMeter meter(callbacks.progress, how.stage, static_cast<std::int64_t>(tiles.size()));
  for (std::size_t first = 0; first < tiles.size(); first += batch) {
    std::vector<std::vector<Grid<float>>> made(std::min(batch, tiles.size() - first));
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, made.size(), [&](std::size_t i) {
        pipeline::UnitProgress progress(meter);
        made[i] = compute(tiles[first + i], [&progress](double done) { progress.advance_to(done); });
        progress.advance_to(1);
      });
    });
    for (std::size_t i = 0; i < made.size(); ++i) {
      use(made[i]);
      file.write(tiles[first + i], made[i]);
    }
  }
  meter.finish();
}

}  // namespace waymark::workflows
