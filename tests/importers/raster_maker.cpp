// SPDX-License-Identifier: Apache-2.0
#include "tests/importers/raster_maker.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/error.hpp"
#include "geo/dem_source.hpp"

namespace waymark::test {
namespace {

void check(CPLErr result) {
  if (result != CE_None) throw std::runtime_error(CPLGetLastErrorMsg());
}

void fill(GDALRasterBand& band, const RasterFile& file) {
  std::vector<double> cells(file.cells.cells().begin(), file.cells.cells().end());
  for (double& cell : cells)
    if (cell == kNoHeight && file.nodata) cell = *file.nodata;
  const int columns = static_cast<int>(file.cells.columns()), rows = static_cast<int>(file.cells.rows());
  check(
      band.RasterIO(GF_Write, 0, 0, columns, rows, cells.data(), columns, rows, GDT_Float64, 0, 0, nullptr));
}

void add_mask(GDALDataset& dataset, Grid<double> mask) {
  check(dataset.CreateMaskBand(GMF_PER_DATASET));
  for (double& shown : mask.cells()) shown *= 255;
  const int columns = static_cast<int>(mask.columns()), rows = static_cast<int>(mask.rows());
  check(dataset.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, columns, rows, mask.cells().data(),
                                                          columns, rows, GDT_Float64, 0, 0, nullptr));
}

}  // namespace

std::string write_raster(const RasterFile& file) {
  GDALAllRegister();
  std::vector<char*> options;
  for (const std::string& option : file.options) options.push_back(const_cast<char*>(option.c_str()));
  options.push_back(nullptr);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(file.driver.c_str());
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.path.c_str(), static_cast<int>(file.cells.columns()),
                     static_cast<int>(file.cells.rows()), file.bands, file.type, options.data()));
  if (!dataset) throw std::runtime_error(CPLGetLastErrorMsg());
  if (file.transform) {
    GeoTransform transform = *file.transform;
    check(dataset->SetGeoTransform(transform.data()));
  }
  if (!file.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(file.crs.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    check(dataset->SetSpatialRef(&crs));
  }
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (file.nodata) check(band.SetNoDataValue(*file.nodata));
  if (!file.unit.empty()) check(band.SetUnitType(file.unit.c_str()));
  if (file.scale != 1) check(band.SetScale(file.scale));
  if (file.offset != 0) check(band.SetOffset(file.offset));
  for (int b = 1; b <= file.bands; ++b) fill(*dataset->GetRasterBand(b), file);
  if (file.mask) add_mask(*dataset, *file.mask);
  return file.path;
}

GeoTransform centred_on(double lon, double lat, double cell) {
  return {lon - cell / 2, cell, 0, lat + cell / 2, 0, -cell};
}

std::optional<std::string> shared_dem(const std::string& name) {
  const std::string path = WAYMARK_SOURCE_DIR "/../shared/data/dem/" + name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

std::string write_text(const std::string& name, const std::string& content) {
  const auto folder = std::filesystem::path(::testing::TempDir()) /
                      ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << content;
  return (folder / name).string();
}

}  // namespace waymark::test
