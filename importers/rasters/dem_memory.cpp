// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem_memory.hpp"

#include <algorithm>

namespace waymark::importers {
namespace {

constexpr double kSmall = 96 << 20, kLarge = 512 << 20;
constexpr std::int64_t kTileRows = 512 + 2;  // of the usual tiles, with neighbours
constexpr double kOfBlocks = 0.7;            // the rest is for GDAL's own cache, and slack

double cell_bytes(CellType type) {
  return type == CellType::int16 ? 2 : type == CellType::float32 ? 4 : 8;
}

}  // namespace

std::int64_t dem_memory(std::int64_t asked, std::span<const RasterHeader> headers) {
  if (asked > 0) return asked;
  double all = 0, strips = 0;
  for (const RasterHeader& header : headers) {
    const double row = cell_bytes(header.cells) * static_cast<double>(header.columns);
    all += row * static_cast<double>(header.rows);
    if (header.block_columns >= kTileRows)
      strips =
          std::max(strips, row * static_cast<double>(std::max<std::int64_t>(kTileRows, header.block_rows)));
  }
  const double bytes = all <= kOfBlocks * kLarge ? kLarge : std::clamp(strips / kOfBlocks, kSmall, kLarge);
  return static_cast<std::int64_t>(bytes);
}

}  // namespace waymark::importers
