// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/crs.hpp"
namespace waymark::inline geo {

/// Georeference of a north-up grid without rotation. Column 0, row 0 is the *centre* of the first cell, for
/// rasters and images in the whole project. GDAL's corner-based geotransforms are shifted by half a cell in
/// importers/ when a file is opened, and nowhere else.
struct Georeference {
  Crs crs = Crs::local();
  double x0 = 0, y0 = 0;   ///< centre of cell (0, 0), CRS units
  double dx = 1, dy = -1;  ///< from one column / row to the next, CRS units; dx > 0, dy < 0

  double x(double column) const { return x0 + column * dx; }
  double y(double row) const { return y0 + row * dy; }
  double column(double at_x) const { return (at_x - x0) / dx; }
  double row(double at_y) const { return (at_y - y0) / dy; }
};

/// Size, georeference and topology of a grid.
struct GridGeometry {
  std::int64_t columns = 0, rows = 0;
  Georeference where;
  bool wraps = false;       ///< column 0 is the eastern neighbour of the last column: a global grid
  bool north_pole = false;  ///< the top row is the last before the pole: no terrain lies beyond it
  bool south_pole = false;

  std::int64_t cells() const { return columns * rows; }
  std::int64_t index(std::int64_t column, std::int64_t row) const { return row * columns + column; }
};

}  // namespace waymark::inline geo
