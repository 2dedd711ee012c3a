// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem_memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark::test {
namespace {

using namespace importers;

constexpr std::int64_t kMegabyte = 1 << 20;

RasterHeader raster(std::int64_t side, int block_columns, int block_rows) {
  RasterHeader header;
  header.columns = header.rows = side;
  header.block_columns = block_columns, header.block_rows = block_rows;
  header.cells = CellType::float32;
  return header;
}

std::int64_t megabytes(std::vector<RasterHeader> headers, std::int64_t asked = 0) {
  return dem_memory(asked, headers) / kMegabyte;
}

TEST(DemMemory, KeepsADemThatFits) {
  EXPECT_EQ(megabytes({raster(8000, 256, 256)}), 512);  // 256 MB
}

TEST(DemMemory, IsSmallForTilesOfALargeDem) {
  EXPECT_EQ(megabytes({raster(32000, 256, 256)}), 96);
  EXPECT_EQ(megabytes(std::vector<RasterHeader>(4, raster(8000, 256, 256))), 96);  // 1 GB in all
}

TEST(DemMemory, HoldsARowOfTilesOfStrips) {
  EXPECT_EQ(megabytes({raster(50000, 50000, 1)}), 140);  // 514 rows of 200 kB are 98 MB
  EXPECT_EQ(megabytes({raster(1000000, 1000000, 1)}), 512);
}

TEST(DemMemory, IsWhatTheUserAsksFor) {
  EXPECT_EQ(megabytes({raster(32000, 256, 256)}, 700 * kMegabyte), 700);
}

}  // namespace
}  // namespace waymark::test
