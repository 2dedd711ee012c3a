// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/wraparound.hpp"

#include <cmath>
#include <optional>

namespace waymark::importers {
namespace {

// Converts cells to longitude and latitude of their centres, degrees, in any CRS.
class CellPositions {
 public:
  explicit CellPositions(const GridGeometry& grid)
      : grid_(grid), transform_(grid.where.crs, geographic_crs(grid.where.crs)) {}
  CrsTransform::XY operator()(std::int64_t column, std::int64_t row) const {
    return transform_(grid_.where.x(static_cast<double>(column)), grid_.where.y(static_cast<double>(row)));
  }

 private:
  const GridGeometry& grid_;
  CrsTransform transform_;
};

// Returns degrees of longitude per column if they are constant and rows have constant latitude.
std::optional<double> degrees_per_column(const GridGeometry& grid, const CellPositions& place) {
  if (grid.columns < 4) return std::nullopt;
  const std::int64_t far = grid.columns / 3;  // less than half a turn even for a global grid
  std::optional<double> step;
  for (const std::int64_t row : {grid.rows / 4, grid.rows / 2, grid.rows * 3 / 4}) {
    const auto a = place(0, row), b = place(far, row);
    const double turned = std::remainder(b.x - a.x, 360) / static_cast<double>(far);
    if (!(turned > 0) || !(std::abs(b.y - a.y) < 1e-9)) return std::nullopt;
    if (step && !(std::abs(turned / *step - 1) < 1e-9)) return std::nullopt;
    step = turned;
  }
  return step;
}

}  // namespace

void mark_wraparound(GridGeometry& grid) {
  if (grid.where.crs.kind() == CrsKind::local) return;
  const CellPositions place(grid);
  const auto step = degrees_per_column(grid, place);
  if (!step) return;
  const auto turn = std::llround(360 / *step);  // files round their cell size, so a turn is rarely exact
  if (std::abs(static_cast<double>(turn) * *step - 360) > 0.25 * *step || grid.columns < turn) return;
  grid.columns = turn;
  grid.wraps = true;
  const double top = place(0, 0).y, bottom = place(0, grid.rows - 1).y;
  const double tall = grid.rows > 1 ? (top - bottom) / static_cast<double>(grid.rows - 1) : 0;
  grid.north_pole = 90 - top <= tall * (1 + 1e-6);
  grid.south_pole = 90 + bottom <= tall * (1 + 1e-6);
}

}  // namespace waymark::importers
