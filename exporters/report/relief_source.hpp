// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "core/units.hpp"
#include "geo/crs.hpp"
namespace waymark {

/// A rectangle of the ground in CRS units.
struct Extent {
  double west = 0, south = 0, east = 0, north = 0;

  double width() const { return east - west; }
  double height() const { return north - south; }
  Extent joined(const Extent& other) const;
};

/// Heights sampled for a picture; NaN where there are none.
struct Relief {
  Extent extent;
  Grid<float> heights;            ///< metres, row 0 in the north
  double cell_x = 0, cell_y = 0;  ///< size of a cell on the ground, metres, both > 0
};

/// Metres on the ground per CRS unit eastwards and northwards in the middle of an extent. A geographic CRS
/// counts the shrinking of parallels, no nearer to a pole than 80 degrees.
struct GroundScale {
  double x = 1, y = 1;
};
GroundScale ground_scale(const Crs& crs, const Extent& extent);

/// Reads the DEMs that GDAL opens under these names, the first one winning where they overlap, at the
/// resolution of a picture whose longer side has `pixels`. Cost is that of the overviews, or of every n-th
/// row where there are none and the file is large. Names that are missing, no raster of one band, or on
/// another body are passed over: the picture is a courtesy of the report. Nothing where none is left.
/// `near_x`: a longitude the map lies at; geographic files are moved by full turns to be near it.
std::optional<Relief> read_relief(const std::vector<std::string>& names, const Crs& crs, double near_x,
                                  std::int64_t pixels);

}  // namespace waymark
