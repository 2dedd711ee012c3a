// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/crs.hpp"
namespace waymark {

/// Where the cells of a grid lie. North-up, no rotation. The convention of the whole project, for rasters and
/// images alike: column 0, row 0 is the *centre* of the first cell. GDAL's corner-based geotransforms are
/// shifted by half a cell in importers/ when a file is opened, and nowhere else.
struct Georeference {
  Crs crs = Crs::local();
  double x0 = 0, y0 = 0;   ///< centre of cell (0, 0), CRS units
  double dx = 1, dy = -1;  ///< from one column / row to the next, CRS units; dx > 0, dy < 0

  double x(double column) const { return x0 + column * dx; }
  double y(double row) const { return y0 + row * dy; }
  double column(double at_x) const { return (at_x - x0) / dx; }
  double row(double at_y) const { return (at_y - y0) / dy; }
};

/// The cells of a DEM as the whole map sees them.
struct GridGeometry {
  std::int64_t columns = 0, rows = 0;
  Georeference where;
  bool wraps = false;       ///< column 0 is the eastern neighbour of the last column: a global grid
  bool north_pole = false;  ///< the top row is the last before the pole: nothing is hidden beyond it
  bool south_pole = false;

  std::int64_t cells() const { return columns * rows; }
  std::int64_t index(std::int64_t column, std::int64_t row) const { return row * columns + column; }
};

}  // namespace waymark
