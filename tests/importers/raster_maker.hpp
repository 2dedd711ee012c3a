// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gdal.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.hpp"
#include "geo/dem_source.hpp"
#include "tests/support/message_of.hpp"
namespace waymark::test {

using GeoTransform = std::array<double, 6>;  ///< as in GDAL: about the corner of the first cell

/// A raster file for a test, in memory by default.
struct RasterFile {
  std::string path = "/vsimem/dem.tif";
  Grid<double> cells = {};  ///< as stored; kNoHeight is written as `nodata`
  GDALDataType type = GDT_Int16;
  std::optional<GeoTransform> transform = GeoTransform{500000, 30, 0, 4000000, 0, -30};
  std::string crs = "EPSG:32633";  ///< empty: none
  std::optional<double> nodata = {};
  std::string unit = {};
  double scale = 1, offset = 0;
  int bands = 1;
  std::optional<Grid<double>> mask = {};  ///< 0 hides a cell
  std::string driver = "GTiff";
  std::vector<std::string> options = {};  ///< of creation, "TILED=YES"
};

/// Writes the file and returns its path.
std::string write_raster(const RasterFile& file);

/// Returns the transform of a file in degrees whose first cell has its centre at (lon, lat).
GeoTransform centred_on(double lon, double lat, double cell);

/// Returns the path of a file of the shared test data; `std::nullopt` if it is not installed.
std::optional<std::string> shared_dem(const std::string& name);

/// Returns all heights of a DEM.
inline geo::HeightWindow all_heights(const geo::DemSource& dem) {
  return dem.read({0, 0, dem.geometry().columns, dem.geometry().rows});
}

/// Writes a plain file with this content in a folder of this test.
std::string write_text(const std::string& name, const std::string& content);

}  // namespace waymark::test
