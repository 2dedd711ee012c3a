// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>
#include "geo/georeference.hpp"
#include "importers/gdal_session.hpp"
namespace waymark {

/// How decoded cells are kept: the smallest type that holds every value of the band.
enum class CellType { int16, float32, float64 };

/// From the band's numbers to heights in metres. A value in [void_low, void_high], NaN and infinities mean
/// that the cell has no height.
struct HeightScale {
  double scale = 1, offset = 0;
  double void_low = std::numeric_limits<double>::quiet_NaN(), void_high = void_low;
  bool whole_metres = false;  ///< the band holds integers that are metres
};

/// What there is to know about a raster file before its cells are read.
struct RasterHeader {
  std::string path;
  std::int64_t columns = 0, rows = 0;
  Georeference where;     ///< of the cells as they are used: north up
  bool south_up = false;  ///< the first row of the file is the southernmost
  int block_columns = 1, block_rows = 1;
  CellType cells = CellType::float64;
  bool masked = false;  ///< a mask band or alpha channel says which cells count
  HeightScale heights;
  std::vector<std::string> warnings;
};

/// Reads the header and refuses what is not a DEM: several bands, complex numbers, rotation, no CRS, degrees
/// where metres should be and the reverse. `crs` replaces the file's own unless empty.
RasterHeader read_header(GDALDataset& dataset, const std::string& path, const std::string& crs);

}  // namespace waymark
