// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/fill_voids.hpp"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <rapidcheck/gtest.h>

#include <ctime>
#include <memory>
#include <vector>

#include "importers/rasters/dem.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

HeightWindow filled(const RasterFile& file) {
  return all_heights(*import_dem({.files = {write_raster(file)}, .nodata = NodataPolicy::fill}));
}

TEST(FillVoids, TakesTheNearestOfFourQuadrants) {
  // Left, right: 10 and 20 at one cell's distance; above and below nothing.
  EXPECT_EQ(filled({.cells = dem_art("10 . 20"), .nodata = -32768}), dem_art("10 15 20"));
}

TEST(FillVoids, RoundsWhereTheFileHoldsWholeMetres) {
  const auto holed = dem_art("10 . 13");
  EXPECT_EQ(filled({.cells = holed, .nodata = -32768}), dem_art("10 12 13"));
  EXPECT_EQ(filled({.cells = holed, .type = GDT_Float32, .nodata = -32768}), dem_art("10 11.5 13"));
}

TEST(FillVoids, KeepsDoublesAsTheyAre) {
  const auto heights =
      filled({.cells = dem_art("8848.123456789 . 8848.1"), .type = GDT_Float64, .nodata = 0});
  EXPECT_EQ(heights(0, 0), 8848.123456789);
}

TEST(FillVoids, LeavesTheMiddleOfAWideVoidEmpty) {
  Grid<double> wide(301, 1, kNoHeight);
  wide(0, 0) = wide(300, 0) = 5;
  const auto heights = filled({.cells = wide, .nodata = -32768});
  EXPECT_EQ(heights(100, 0), 5);
  EXPECT_EQ(heights(101, 0), kNoHeight);
  EXPECT_EQ(heights(150, 0), kNoHeight);
}

TEST(FillVoids, DistanceIsAnOptionAndCounted) {
  Grid<double> wide(301, 1, kNoHeight);
  wide(0, 0) = wide(300, 0) = 5;
  const auto dem = import_dem({.files = {write_raster({.cells = wide, .nodata = -32768})},
                               .nodata = NodataPolicy::fill,
                               .fill_distance = 20});
  const HeightWindow heights = all_heights(*dem);
  EXPECT_EQ(heights(20, 0), 5);
  EXPECT_EQ(heights(21, 0), kNoHeight);
  EXPECT_EQ(dem->faults({0, 0, 301, 1}).filled, 40);
  EXPECT_EQ(dem->faults({10, 0, 30, 1}).filled, 11);
}

// 100 windows in a void of 16 M cells: GDAL would take 10 ms for each.
TEST(FillVoids, CostsNothingFarFromData) {
  const std::string file = "/vsimem/sparse.tif";
  {
    GDALAllRegister();
    const char* sparse[] = {"SPARSE_OK=TRUE", "TILED=YES", nullptr};
    const std::unique_ptr<GDALDataset> made(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file.c_str(), 4096, 4096, 1, GDT_Float32, const_cast<char**>(sparse)));
    double where[] = {500000, 30, 0, 4000000, 0, -30};
    made->SetGeoTransform(where);
    OGRSpatialReference crs;
    crs.importFromEPSG(32633);
    made->SetSpatialRef(&crs);
    made->GetRasterBand(1)->SetNoDataValue(-9999);
    std::vector<float> block(256 * 256, 7);
    ASSERT_EQ(made->GetRasterBand(1)->WriteBlock(0, 0, block.data()), CE_None);
  }
  const auto dem = import_dem({.files = {file}, .nodata = NodataPolicy::fill});
  EXPECT_EQ(dem->read({300, 100, 1, 1})(0, 0), 7);
  const std::clock_t begin = std::clock();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(dem->read({1024 + 16 * i, 2048, 64, 64})(0, 0), kNoHeight);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 0.5);
}

TEST(FillVoids, StaysInsideTheGrid) {
  const auto file = write_raster({.cells = dem_art("10 . 20"), .nodata = -32768});
  const auto dem = import_dem({.files = {file}, .nodata = NodataPolicy::fill});
  EXPECT_EQ(dem->read({-1, -1, 5, 3}), dem_art(". . . . . / . 10 15 20 . / . . . . ."));
}

TEST(FillVoids, SeesAcrossTheSeamOfAGlobalGrid) {
  const auto file = write_raster({.cells = dem_art(". 2 2 2 2 2 2 6 / 1 1 1 1 1 1 1 1"),
                                  .transform = GeoTransform{0, 45, 0, 45, 0, -45},
                                  .crs = "EPSG:4326",
                                  .nodata = -32768});
  const auto dem = import_dem({.files = {file}, .nodata = NodataPolicy::fill});
  EXPECT_EQ(dem->read({0, 0, 1, 1}), dem->read({8, 0, 1, 1}));
  EXPECT_GT(dem->read({0, 0, 1, 1})(0, 0), 2) << "the 6 is a neighbour";
}

RC_GTEST_PROP(FillVoids, AnyWindowGivesTheSameCells, ()) {
  static const auto dem = [] {
    Grid<double> cells = random_terrain(4, 260, 240);
    for (std::int64_t row = 40; row < 200; ++row)  // wider than can be filled
      for (std::int64_t column = 20; column < 240; ++column)
        if ((row * 31 + column * 17) % 97 != 0 || (row > 90 && row < 130)) cells(column, row) = kNoHeight;
    const auto file = write_raster({.path = "/vsimem/holed.tif", .cells = cells, .nodata = -32768});
    return import_dem({.files = {file}, .nodata = NodataPolicy::fill});
  }();
  static const HeightWindow whole = all_heights(*dem);
  const Window window{*rc::gen::inRange(-5, 255), *rc::gen::inRange(-5, 235), *rc::gen::inRange(1, 60),
                      *rc::gen::inRange(1, 60)};
  const HeightWindow heights = dem->read(window);
  for (std::int64_t row = 0; row < window.rows; ++row)
    for (std::int64_t column = 0; column < window.columns; ++column) {
      const std::int64_t c = window.column + column, r = window.row + row;
      RC_ASSERT(heights(column, row) == (whole.contains(c, r) ? whole(c, r) : kNoHeight));
    }
}

// Does the same as gdal_fillnodata.py: copies, then fills the copy in its own data type.
Grid<double> filled_by_gdal(const std::string& path) {
  const std::unique_ptr<GDALDataset> source(GDALDataset::Open(path.c_str()));
  const std::unique_ptr<GDALDataset> copy(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
      "/vsimem/copy.tif", source.get(), false, nullptr, nullptr, nullptr));
  GDALRasterBand& band = *copy->GetRasterBand(1);
  EXPECT_EQ(GDALFillNodata(&band, nullptr, 100, 0, 0, nullptr, nullptr, nullptr), CE_None);
  Grid<double> cells(copy->GetRasterXSize(), copy->GetRasterYSize());
  const int columns = copy->GetRasterXSize(), rows = copy->GetRasterYSize();
  EXPECT_EQ(band.RasterIO(GF_Read, 0, 0, columns, rows, cells.cells().data(), columns, rows, GDT_Float64, 0,
                          0, nullptr),
            CE_None);
  for (double& cell : cells.cells())
    if (cell == -32768) cell = kNoHeight;
  return cells;
}

TEST(FillVoids, EqualsGdalOnTheBerneseAlps) {
  const auto path = shared_dem("earth/N46E008.tif");
  if (!path) GTEST_SKIP() << "the shared test data is not here";
  const auto dem = import_dem({.files = {*path}, .nodata = NodataPolicy::fill});
  Grid<double> tiled(1201, 1201);
  for (std::int64_t top = 0; top < 1201; top += 171)
    for (std::int64_t left = 0; left < 1201; left += 257) {
      const Window window{left, top, std::min<std::int64_t>(257, 1201 - left),
                          std::min<std::int64_t>(171, 1201 - top)};
      const HeightWindow heights = dem->read(window);
      for (std::int64_t row = 0; row < window.rows; ++row)
        std::ranges::copy(heights.row(row), tiled.row(top + row).begin() + left);
    }
  EXPECT_EQ(tiled, filled_by_gdal(*path));
}

}  // namespace
}  // namespace waymark::test
