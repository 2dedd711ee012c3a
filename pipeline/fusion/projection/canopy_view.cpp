// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/canopy_view.hpp"

#include <cmath>

namespace waymark::pipeline {

ImageView canopy_view(const CanopySource& canopy) {
  const GridGeometry& grid = canopy.geometry();
  const Georeference& where = grid.where;
  const double unit = where.crs.metres_per_unit();
  ImageView view;
  view.name = canopy.name();
  view.columns = grid.columns, view.rows = grid.rows;
  view.ortho = OrthoGrid{where.x0 * unit, where.y0 * unit, where.dx * unit, where.dy * unit};
  const double west = where.x(-0.5), east = where.x(static_cast<double>(grid.columns) - 0.5);
  const double north = where.y(-0.5), south = where.y(static_cast<double>(grid.rows) - 0.5);
  view.footprint = {{{west, south}, {east, south}, {east, north}, {west, north}, {west, south}}};
  const double cell = std::abs(where.dx * where.dy) * unit * unit;
  view.area = cell * static_cast<double>(grid.cells());
  view.gsd = std::sqrt(cell);
  return view;
}

}  // namespace waymark::pipeline
