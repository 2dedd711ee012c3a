// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gdal.h>
#include <array>
#include <functional>
#include <string>
namespace waymark::test {

/// A GeoTIFF to be made. Cells of 1 km in UTM unless said otherwise.
struct MadeDem {
  int columns = 7, rows = 3;
  std::function<double(int column, int row)> height = [](int, int) { return 0.0; };
  GDALDataType cell_type = GDT_Float32;
  int bands = 1;
  std::string crs = "EPSG:32632";  ///< empty: none
  std::array<double, 6> geotransform = {500000, 1000, 0, 5200000, 0, -1000};
  double nodata = -9999;
  bool compressed_blocks = false;  ///< of 256 x 256 cells
};
std::string make_dem(const std::string& file, const MadeDem& dem);

/// Overwrites a tenth of the file, beginning at `part` of its length, with zeros.
void damage(const std::string& file, double part);

/// Two summits: 900 m, and 700 m behind a saddle of 400 m, 4 km apart.
///   0 0 0 0 0 0 0
///   0 9 5 4 5 7 0
///   0 0 0 0 0 0 0    times 100 m
MadeDem twin_peaks();

/// Rolling ground with some hundred summits, the same on every machine.
MadeDem hills(int columns, int rows);

}  // namespace waymark::test
