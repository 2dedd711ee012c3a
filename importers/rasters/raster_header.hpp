// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>
#include "geo/dem_source.hpp"
#include "geo/georeference.hpp"
#include "importers/gdal_session.hpp"
namespace waymark::importers {

struct HeightUnit {
  double metres = 1;
  bool known = true;
};

/// Returns the unit of a band by any of its usual names, in any case. An empty name means metres.
HeightUnit height_unit(std::string_view name);

/// Returns the unit that a user named. Throws Error{usage} with the names for an unknown one.
HeightUnit stated_height_unit(std::string_view name);

/// Type of decoded cells: the smallest that holds every value of the band.
enum class CellType { int16, float32, float64 };

/// Conversion from the band's numbers to heights in metres. A value in [min_void, max_void], NaN and
/// infinities mean that the cell has no height, and so does a height beyond the limits.
struct HeightScale {
  double scale = 1, offset = 0;
  double min_void = std::numeric_limits<double>::quiet_NaN(), max_void = min_void;
  double min_height = waymark::kMinHeight,
         max_height = waymark::kMaxHeight;  ///< qualified: some files have their own
  bool whole_metres = false;                ///< the band holds integers that are metres
};

/// Properties of a raster file, known before its cells are read.
struct RasterHeader {
  std::string path;
  std::int64_t columns = 0, rows = 0;
  Georeference where;     ///< of the cells as used: north up
  bool south_up = false;  ///< the first row of the file is the southernmost
  int band = 1;           ///< from 1
  int block_columns = 1, block_rows = 1;
  bool square_blocks =
      false;  ///< none has more than 1024 columns; virtual rasters hide those of their sources
  CellType cells = CellType::float64;
  bool masked = false;  ///< a mask band or alpha channel marks the valid cells
  HeightScale heights;
  std::vector<std::string> warnings;
};

/// What the user states about the rasters of a DEM. Defaults: the file's own.
struct RasterReading {
  std::string crs = {};          ///< replaces the file's own
  int band = 0;                  ///< of the heights, from 1; 0: the only one
  std::string height_unit = {};  ///< replaces the band's unit: "m", "ft", "us-ft", ...
  double height_scale = 1;       ///< factor of all heights
};

/// Reads the header. Throws Error for a file that is not a DEM: several bands, complex numbers, rotation, no
/// CRS, degrees in a metric CRS and the reverse.
RasterHeader read_header(GDALDataset& dataset, const std::string& path, const RasterReading& reading);

}  // namespace waymark::importers
