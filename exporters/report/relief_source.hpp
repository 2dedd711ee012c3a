// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "core/units.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// A rectangle in CRS units.
struct Extent {
  double west = 0, south = 0, east = 0, north = 0;

  double width() const { return east - west; }
  double height() const { return north - south; }
  Extent united(const Extent& other) const;
  /// Returns the common part; width or height is not above 0 if there is none.
  Extent common(const Extent& other) const;
};

/// Heights sampled for a picture; NaN for unknown ones.
struct Relief {
  Extent extent;
  Grid<float> heights;            ///< metres, row 0 in the north
  double cell_x = 0, cell_y = 0;  ///< size of a cell on the ground, metres, both > 0
};

/// Metres on the ground per CRS unit eastwards and northwards in the middle of an extent. For a geographic
/// CRS this includes the convergence of meridians, at most to 80 degrees of latitude.
struct GroundScale {
  double x = 1, y = 1;
};
GroundScale ground_scale(const Crs& crs, const Extent& extent);

/// Reads the DEMs that GDAL opens under these names, at the resolution of a picture whose longer side has
/// `pixels`. The first one has priority if they overlap.
/// - Cost is that of the overviews, or of every n-th row of a large file without them.
/// - Missing files, other rasters and those of another body are skipped, since the picture is optional.
/// - `near_x` is a longitude of the map; geographic files are shifted by whole turns to be near it.
/// - `within`: only this rectangle is read, where it meets the DEMs.
/// `std::nullopt` if no DEM is left, or none within `within`.
std::optional<Relief> read_relief(const std::vector<std::string>& names, const Crs& crs, double near_x,
                                  std::int64_t pixels, const std::optional<Extent>& within = {});

/// Returns the `pixels` at which a picture of all DEMs under these names has the cells of the finest one, at
/// most `max_pixels`; 0 if there is no DEM.
std::int64_t relief_pixels(const std::vector<std::string>& names, const Crs& crs, double near_x,
                           std::int64_t max_pixels);

/// Returns the rectangle of all DEMs under these names; `std::nullopt` if there is none.
std::optional<Extent> relief_extent(const std::vector<std::string>& names, const Crs& crs, double near_x);

}  // namespace waymark::exporters
