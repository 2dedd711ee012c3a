// SPDX-License-Identifier: Apache-2.0
#include "geo/plane_dem.hpp"

#include "core/error.hpp"

namespace waymark::inline geo {

PlaneDem::PlaneDem(const Crs& crs, double height, double height_sd) : height_(height), height_sd_(height_sd) {
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, "a flat terrain needs a CRS in metres, not degrees", crs.name(),
                "name a projected CRS (UTM, +proj=tmerc ...) or local");
  constexpr std::int64_t kCells = 1001;
  const double step = 4e4 / crs.metres_per_unit();
  const double half = step * (kCells - 1) / 2;
  geometry_.columns = geometry_.rows = kCells;
  geometry_.where = {crs, -half, half, step, -step};
}

HeightWindow PlaneDem::read(const Window& window) const {
  HeightWindow heights(window.columns, window.rows, kNoHeight);
  for (std::int64_t r = 0; r < window.rows; ++r)
    for (std::int64_t c = 0; c < window.columns; ++c) {
      const std::int64_t column = window.column + c, row = window.row + r;
      if (column >= 0 && row >= 0 && column < geometry_.columns && row < geometry_.rows)
        heights(c, r) = height_;
    }
  return heights;
}

bool is_assumed_plane(const DemSource& dem) {
  return dynamic_cast<const PlaneDem*>(&dem) != nullptr;
}

}  // namespace waymark::inline geo
