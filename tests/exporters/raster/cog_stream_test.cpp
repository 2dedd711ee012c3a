// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/cog_stream.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/locked_folder.hpp"
#include "core/text_file.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

constexpr std::int64_t kColumns = 1300, kRows = 900;

float cell(std::int64_t column, std::int64_t row, std::size_t band) {
  if ((column * 7 + row * 3) % 101 == 0) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(std::sin(0.01 * double(column)) * double(row) + double(band));
}

std::string made_bytes(std::size_t threads, std::int64_t window_size) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const LockedFolder folder(std::filesystem::temp_directory_path());
  const std::filesystem::path path = folder.path() / "made.tif";
  CogStream file(path, {{"height", "m"}, {"slope", "deg"}},
                 {kColumns, kRows, {Crs::from_text("EPSG:32632"), 500000, 5e6, 2, -2}});
  for (std::int64_t row = 0; row < kRows; row += window_size)
    for (std::int64_t column = 0; column < kColumns; column += window_size) {
      const Window window{column, row, std::min(window_size, kColumns - column),
                          std::min(window_size, kRows - row)};
      std::vector<Grid<float>> bands(2, Grid<float>(window.columns, window.rows));
      for (std::size_t b = 0; b < 2; ++b)
        for (std::int64_t r = 0; r < window.rows; ++r)
          for (std::int64_t c = 0; c < window.columns; ++c) bands[b](c, r) = cell(column + c, row + r, b);
      file.write(window, bands);
    }
  file.commit({{"NAME", "made"}});
  const GDALDatasetUniquePtr read(GDALDataset::Open(path.c_str()));
  std::vector<float> cells(std::size_t{kColumns * kRows});
  EXPECT_EQ(read->GetRasterBand(2)->RasterIO(GF_Read, 0, 0, kColumns, kRows, cells.data(), kColumns, kRows,
                                             GDT_Float32, 0, 0, nullptr),
            CE_None);
  std::size_t different = 0;
  for (std::int64_t row = 0; row < kRows; ++row)
    for (std::int64_t column = 0; column < kColumns; ++column) {
      const float is = cells[static_cast<std::size_t>(row * kColumns + column)], was = cell(column, row, 1);
      different += !(is == was || (std::isnan(is) && std::isnan(was)));
    }
  EXPECT_EQ(different, 0u);
  EXPECT_EQ(read->GetRasterBand(1)->GetOverviewCount(), 2);
  return read_text(path, "raster");
}

TEST(CogStream, GivesTheSameBytesForAnyThreadsAndWindows) {
  const std::string one = made_bytes(1, 2000);
  EXPECT_GT(one.size(), 1'000'000u);
  EXPECT_TRUE(made_bytes(2, 512) == one);
  EXPECT_TRUE(made_bytes(5, 100) == one);
}

}  // namespace
}  // namespace waymark::test
