// SPDX-License-Identifier: Apache-2.0
#include "made_dem.hpp"

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

namespace waymark::test {

std::string make_dem(const std::string& file, const MadeDem& dem) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const char* blocks[] = {"TILED=YES", "COMPRESS=DEFLATE", nullptr};
  const std::unique_ptr<GDALDataset> made(
      driver->Create(file.c_str(), dem.columns, dem.rows, dem.bands, dem.cell_type,
                     dem.compressed_blocks ? const_cast<char**>(blocks) : nullptr));
  if (!made) throw std::runtime_error("cannot make " + file);
  std::array<double, 6> geotransform = dem.geotransform;
  made->SetGeoTransform(geotransform.data());
  if (!dem.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(dem.crs.c_str());
    made->SetSpatialRef(&crs);
  }
  std::vector<double> row(static_cast<std::size_t>(dem.columns));
  for (int band = 1; band <= dem.bands; ++band) {
    made->GetRasterBand(band)->SetNoDataValue(dem.nodata);
    for (int r = 0; r < dem.rows; ++r) {
      for (int c = 0; c < dem.columns; ++c) row[static_cast<std::size_t>(c)] = dem.height(c, r);
      if (made->GetRasterBand(band)->RasterIO(GF_Write, 0, r, dem.columns, 1, row.data(), dem.columns, 1,
                                              GDT_Float64, 0, 0) != CE_None)
        throw std::runtime_error("cannot write " + file);
    }
  }
  return file;
}

void damage(const std::string& file, double part) {
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(part * size));
  bytes << std::string(static_cast<std::size_t>(0.1 * size), '\0');
}

MadeDem twin_peaks() {
  return {.height = [](int column, int row) {
    constexpr std::array ridge = {0, 900, 500, 400, 500, 700, 0};
    return row == 1 ? ridge.at(static_cast<std::size_t>(column)) : 0.0;
  }};
}

MadeDem hills(int columns, int rows) {
  // Value noise of two octaves from an integer hash (Wang 2007): no library's random numbers, no sine.
  const auto hash = [](std::uint32_t x) {
    x = (x ^ 61U) ^ (x >> 16U);
    x *= 9U;
    x ^= x >> 4U;
    x *= 0x27d4eb2dU;
    return x ^ (x >> 15U);
  };
  const auto noise = [hash](int column, int row, int step) {
    const auto knot = [&](int c, int r) {
      return static_cast<double>(hash(static_cast<std::uint32_t>(c * 7919 + r)) % 1000);
    };
    const int c = column / step, r = row / step;
    const double u = static_cast<double>(column % step) / step, v = static_cast<double>(row % step) / step;
    return (1 - v) * ((1 - u) * knot(c, r) + u * knot(c + 1, r)) +
           v * ((1 - u) * knot(c, r + 1) + u * knot(c + 1, r + 1));
  };
  return {.columns = columns, .rows = rows, .height = [noise](int column, int row) {
            return 1000 + noise(column, row, 23) + 0.2 * noise(column, row, 5);
          }};
}

}  // namespace waymark::test
