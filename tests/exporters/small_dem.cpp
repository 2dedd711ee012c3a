// SPDX-License-Identifier: Apache-2.0
#include "small_dem.hpp"

#include <gdal_priv.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "geo/crs.hpp"

namespace waymark::test {

void write_small_dem(const std::filesystem::path& path, double west, double north, double cell) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), 100, 100, 1, GDT_Float32, nullptr));
  std::array<double, 6> transform = {west, cell, 0, north, 0, -cell};
  file->SetGeoTransform(transform.data());
  file->SetProjection(Crs::from_text("EPSG:4326").wkt1().c_str());
  std::vector<float> heights;
  for (int row = 0; row < 100; ++row)
    for (int column = 0; column < 100; ++column)
      heights.push_back(1000 -
                        10 * std::hypot(static_cast<float>(column) - 49.5f, static_cast<float>(row) - 49.5f));
  heights[0] = -9999;
  file->GetRasterBand(1)->SetNoDataValue(-9999);
  const CPLErr failed = file->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 100, 100, heights.data(), 100, 100,
                                                         GDT_Float32, 0, 0, nullptr);
  if (failed != CE_None) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace waymark::test
