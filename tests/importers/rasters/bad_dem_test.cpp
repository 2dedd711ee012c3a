// SPDX-License-Identifier: Apache-2.0
// Files that are no DEM, and their messages.
#include <gmock/gmock.h>

#include <cpl_vsi.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "importers/rasters/dem.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const Grid<double> kThreeByThree = dem_art("1 2 3 / 4 9 6 / 7 8 5");

std::string complaint_about(const std::string& path, const std::string& crs = {}) {
  ::testing::internal::CaptureStderr();
  const std::string message = message_of([&] { import_dem({.files = {path}, .crs = crs}); });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "GDAL may not speak for itself";
  return message;
}

std::string complaint_about(const RasterFile& file) {
  return complaint_about(write_raster(file));
}

/// Lets the values of a tag of a TIFF in memory, little-endian, lie beyond its end.
void lose_tag(const std::string& path, std::uint16_t tag) {
  vsi_l_offset bytes = 0;
  GByte* const file = VSIGetMemFileBuffer(path.c_str(), &bytes, FALSE);
  std::uint32_t directory = 0, beyond = static_cast<std::uint32_t>(bytes) + 1000;
  std::memcpy(&directory, file + 4, 4);
  std::uint16_t entries = 0, number = 0;
  std::memcpy(&entries, file + directory, 2);
  for (std::uint16_t i = 0; i < entries; ++i) {
    GByte* const entry = file + directory + 2 + 12 * i;
    std::memcpy(&number, entry, 2);
    if (number == tag) return static_cast<void>(std::memcpy(entry + 8, &beyond, 4));
  }
  FAIL() << "the file has no tag " << tag;
}

// GDAL only warns, and goes on without them.
TEST(BadDem, TagsThatTheFileLacks) {
  for (const auto& [tag, name] : {std::pair{33550, "GeoPixelScale"}, {34735, "GeoKeyDirectory"}}) {
    const std::string path =
        write_raster({.path = std::string("/vsimem/") + name + ".tif", .cells = kThreeByThree});
    lose_tag(path, static_cast<std::uint16_t>(tag));
    EXPECT_THAT(complaint_about(path, "EPSG:32633"), AllOf(HasSubstr("a part of the header cannot be read"),
                                                           HasSubstr(name), HasSubstr("damaged")));
  }
}

TEST(BadDem, NothingGiven) {
  EXPECT_THAT(message_of([] { import_dem({}); }), HasSubstr("no DEM is given"));
}

TEST(BadDem, Missing) {
  EXPECT_THAT(complaint_about("/no/such/dem.tif"),
              AllOf(HasSubstr("there is no such file"), HasSubstr("\n  /no/such/dem.tif\n  check the path")));
}

TEST(BadDem, Empty) {
  const std::string path = write_text("empty.tif", "");
  EXPECT_THAT(complaint_about(path), AllOf(HasSubstr("the file is empty"), HasSubstr(path)));
}

TEST(BadDem, NotARaster) {
  const std::string path = write_text("letter.tif", "Dear Sir or Madam");
  EXPECT_THAT(complaint_about(path), AllOf(HasSubstr("this is not a raster that GDAL reads: not recognized"),
                                           HasSubstr(path), HasSubstr("gdalinfo --formats")));
}

TEST(BadDem, Truncated) {
  const std::string path = write_text("cut.tif", "");
  write_raster(
      {.path = path, .cells = random_terrain(5, 300, 300), .options = {"COMPRESS=DEFLATE", "TILED=YES"}});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
  EXPECT_THAT(complaint_about(path),
              AllOf(HasSubstr("block (1, 1) of the file cannot be read: "), HasSubstr("\n  " + path + "\n"),
                    HasSubstr("truncated or damaged")));
}

// GDAL reads what these formats lack as zeros.
TEST(BadDem, TruncatedWithoutCompression) {
  const GDALDatasetH tiff = GDALOpen(write_raster({.cells = random_terrain(5, 90, 90)}).c_str(), GA_ReadOnly);
  for (const auto& [driver, name] : {std::pair{"ENVI", "cut.dat"}, {"netCDF", "cut.nc"}}) {
    const std::string path = write_text(name, "");
    GDALClose(GDALCreateCopy(GDALGetDriverByName(driver), path.c_str(), tiff, 0, nullptr, nullptr, nullptr));
    EXPECT_NO_THROW(import_dem({.files = {path}, .crs = "EPSG:32633"})) << driver;
    std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
    EXPECT_THAT(complaint_about(path, "EPSG:32633"), HasSubstr("truncated: fetch or write it again"))
        << driver;
  }
  GDALClose(tiff);
}

// GDAL's own reading of a late row does not end there.
TEST(BadDem, TruncatedText) {
  std::string text = "ncols 3\nnrows 200\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  for (int row = 0; row < 90; ++row) text += "1.5 2.5 3.5\n";
  EXPECT_THAT(complaint_about(write_text("cut.asc", text)),
              AllOf(HasSubstr("row 91 of 200 cannot be read: "), HasSubstr("truncated or damaged")));
}

TEST(BadDem, DamagedInTheMiddle) {
  const std::string path = write_text("scratched.tif", "");
  write_raster(
      {.path = path, .cells = random_terrain(5, 600, 600), .options = {"COMPRESS=DEFLATE", "TILED=YES"}});
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path));
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(size / 4);
  file << std::string(static_cast<std::size_t>(size / 2),
                      '\0');  // hits the beginnings of blocks, which are checked
  file.close();
  const auto dem = import_dem({.files = {path}, .inspect = false});
  EXPECT_THAT(message_of([&] { dem->read({0, 0, 600, 600}); }), HasSubstr("of the file cannot be read"));
}

TEST(BadDem, ThreeBands) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .type = GDT_Byte, .bands = 3}),
              AllOf(HasSubstr("a DEM has one band of heights, this file has 3"),
                    HasSubstr("gdal_translate -b 1 '/vsimem/dem.tif' dem.tif")));
}

TEST(BadDem, ComplexNumbers) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .type = GDT_CFloat32}),
              HasSubstr("heights are real numbers, this file holds complex ones (CFloat32)"));
}

TEST(BadDem, NoCrs) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .crs = ""}),
              AllOf(HasSubstr("the file has no coordinate reference system"), HasSubstr("--crs EPSG:32611"),
                    HasSubstr("--crs local"), Not(HasSubstr("look like degrees"))));
}

TEST(BadDem, DegreesWithoutAnEllipsoid) {
  EXPECT_THAT(
      complaint_about({.cells = kThreeByThree, .transform = centred_on(8, 46, 1.0 / 1200), .crs = ""}),
      AllOf(HasSubstr("its numbers look like degrees: pass --crs EPSG:4326 if this is Earth"),
            HasSubstr("IAU_2015:49900 if Mars")));
}

TEST(BadDem, DegreesWhereMetresAreDeclared) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .transform = centred_on(8, 46, 1.0 / 1200)}),
              AllOf(HasSubstr("EPSG:32633 is in metres, but these look like degrees: x 7.99"),
                    HasSubstr("--crs EPSG:4326")));
}

TEST(BadDem, MetresWhereDegreesAreDeclared) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .crs = "EPSG:4326"}),
              AllOf(HasSubstr("EPSG:4326 is in degrees, but these are none: x 499985 to 500105"),
                    HasSubstr("pass --crs with the projection")));
}

TEST(BadDem, UnknownCrs) {
  EXPECT_THAT(complaint_about(write_raster({.cells = kThreeByThree}), "EPSG:123456"),
              HasSubstr("crs not found"));
}

TEST(BadDem, NoPlace) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .transform = {}}),
              HasSubstr("the file has no geotransform"));
}

TEST(BadDem, Rotated) {
  EXPECT_THAT(
      complaint_about({.cells = kThreeByThree, .transform = GeoTransform{500000, 30, 5, 4000000, 5, -30}}),
      AllOf(HasSubstr("the grid is rotated"), HasSubstr("gdalwarp '/vsimem/dem.tif' dem.tif")));
}

TEST(BadDem, EastToWest) {
  EXPECT_THAT(
      complaint_about({.cells = kThreeByThree, .transform = GeoTransform{500000, -30, 0, 4000000, 0, -30}}),
      HasSubstr("columns must run from west to east"));
}

TEST(BadDem, NoHeightAtAll) {
  EXPECT_THAT(complaint_about({.cells = Grid<double>(2000, 1500, kNoHeight), .nodata = -32768}),
              AllOf(HasSubstr("the DEM has no heights: every cell is no-data"), HasSubstr("gdalinfo -mm")));
}

TEST(BadDem, ScaleOfZero) {
  EXPECT_THAT(complaint_about({.cells = kThreeByThree, .scale = 0}),
              HasSubstr("heights would be 0 times the cell"));
}

TEST(BadDem, VirtualRasterWithoutItsSource) {
  const std::string source = write_raster({.path = write_text("source.tif", ""), .cells = kThreeByThree});
  const std::string vrt = "/vsimem/mosaic.vrt";
  GDALDatasetH opened = GDALOpen(source.c_str(), GA_ReadOnly);
  GDALClose(GDALCreateCopy(GDALGetDriverByName("VRT"), vrt.c_str(), opened, 0, nullptr, nullptr, nullptr));
  GDALClose(opened);
  EXPECT_EQ(import_dem({.files = {vrt}})->read({1, 1, 1, 1})(0, 0), 9);
  std::filesystem::remove(source);
  EXPECT_THAT(complaint_about(vrt),
              AllOf(HasSubstr("cannot be read: "), HasSubstr("source.tif: No such file or directory")));
}

TEST(BadDem, SeveralDataSetsInOneFile) {
  const std::string path = write_text("two.gpkg", "");
  std::filesystem::remove(path);
  for (const char* table : {"RASTER_TABLE=summer", "RASTER_TABLE=winter"}) {
    const bool again = std::filesystem::exists(path);
    write_raster({.path = path,
                  .cells = kThreeByThree,
                  .type = GDT_Float32,
                  .driver = "GPKG",
                  .options = {table, again ? "APPEND_SUBDATASET=YES" : "APPEND_SUBDATASET=NO"}});
  }
  EXPECT_THAT(complaint_about(path), AllOf(HasSubstr("the file itself contains no raster"),
                                           HasSubstr("name one of its data sets, e.g. GPKG:")));
}

}  // namespace
}  // namespace waymark::test
