// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/raster_file.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "exporters/raster/image_file.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

namespace fs = std::filesystem;

class RasterFile : public ::testing::Test {
 protected:
  RasterFile()
      : folder_(fs::path(::testing::TempDir()) / ("waymark_raster_file_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);  // the tests run side by side, each in a process of its own
    fs::create_directories(folder_);
  }
  ~RasterFile() override { fs::remove_all(folder_); }
  static GDALDatasetUniquePtr open(const fs::path& path) {
    return GDALDatasetUniquePtr(GDALDataset::Open(path.c_str()));
  }

  fs::path folder_;
};

TEST_F(RasterFile, KeepsHeightsPlaceAndCrs) {
  Grid<float> cells(3, 2, 1.5F);
  cells(2, 1) = std::nanf("");
  write_raster(folder_ / "dem.tif", cells, {Crs::from_text("EPSG:32651"), 500000, 4000000, 2, -2});
  const auto file = open(folder_ / "dem.tif");
  ASSERT_TRUE(file);
  double transform[6];
  file->GetGeoTransform(transform);
  EXPECT_EQ(transform[0], 500000 - 1);  // the corner of the first cell
  EXPECT_EQ(transform[3], 4000000 + 1);
  EXPECT_EQ(transform[5], -2);
  EXPECT_TRUE(file->GetSpatialRef()->IsProjected());
  float values[6];
  ASSERT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 3, 2, values, 3, 2, GDT_Float32, 0, 0, nullptr),
            CE_None);
  EXPECT_EQ(values[0], 1.5F);
  EXPECT_TRUE(std::isnan(values[5]));
}

TEST_F(RasterFile, ImagesKeepTheirBrightness) {
  Pixels image(4, 1);
  image(0, 0) = 0, image(1, 0) = 0.5F, image(2, 0) = 1.7F, image(3, 0) = std::nanf("");
  for (const int bits : {8, 16}) {
    write_image(folder_ / "image.png", image, bits);
    const auto file = open(folder_ / "image.png");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->GetRasterBand(1)->GetRasterDataType(), bits == 8 ? GDT_Byte : GDT_UInt16);
    std::uint16_t values[4];
    ASSERT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 4, 1, values, 4, 1, GDT_UInt16, 0, 0, nullptr),
              CE_None);
    EXPECT_THAT(values, ::testing::ElementsAre(0, bits == 8 ? 128 : 32768, bits == 8 ? 255 : 65535, 0));
  }
}

TEST_F(RasterFile, SaysWhereItCannotWrite) {
  for (const bool raster : {true, false}) try {
      if (raster)
        write_raster(folder_ / "missing/dem.tif", Grid<float>(2, 2, 0.0F), {});
      else
        write_image(folder_ / "missing/image.png", Pixels(2, 2, 0.0F), 8);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::output);
      EXPECT_THAT(error.what(), ::testing::HasSubstr("missing\n  create the folder"));
    }
}

}  // namespace
}  // namespace waymark::test
