// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/dem_terrain.hpp"

#include <fmt/format.h>

#include <memory>
#include <mutex>
#include <optional>

#include "core/error.hpp"
#include "geo/metric_crs.hpp"

namespace waymark::pipeline {
namespace {

std::string name_of(const DemSource& dem) {
  const auto files = dem.files();
  return files.empty() ? "the DEM" : files.front();
}

}  // namespace

void check_metric(const DemSource& dem) {
  if (dem.geometry().where.crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::input, "projecting images needs a DEM in metres; this one is in degrees",
                name_of(dem), "warp it: gdalwarp -t_srs " + fitting_metric_crs(dem.geometry()));
}

Terrain read_terrain(const DemSource& dem, const Window& window) {
  check_metric(dem);
  const GridGeometry& grid = dem.geometry();
  const double unit = grid.where.crs.metres_per_unit();
  const HeightWindow cells = dem.read(window);
  Grid<float> heights(cells.columns(), cells.rows());
  for (std::int64_t r = 0; r < cells.rows(); ++r)
    for (std::int64_t c = 0; c < cells.columns(); ++c) heights(c, r) = static_cast<float>(cells(c, r));
  return {std::move(heights),
          grid.where.x(static_cast<double>(window.column)) * unit,
          grid.where.y(static_cast<double>(window.row)) * unit,
          grid.where.dx * unit,
          -grid.where.dy * unit,
          dem.height_sd()};
}

Terrain load_terrain(const DemHandle& dem, std::int64_t max_cells) {
  struct Kept {
    DemHandle dem;
    Terrain terrain;
  };
  static std::mutex mutex;
  static std::optional<Kept> last;
  const GridGeometry& grid = dem->geometry();
  if (grid.cells() > max_cells)
    throw Error(
        ErrorCode::input,
        fmt::format("a DEM of {} x {} cells does not fit in memory as terrain", grid.columns, grid.rows),
        name_of(*dem), "crop it to the area of the images: gdalwarp -te or gdal_translate -projwin");
  const std::scoped_lock lock(mutex);
  if (!last || last->dem != dem) last = Kept{dem, read_terrain(*dem, {0, 0, grid.columns, grid.rows})};
  return last->terrain;
}

}  // namespace waymark::pipeline
