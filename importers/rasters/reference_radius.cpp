// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/reference_radius.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geo/dem_source.hpp"
#include "importers/rasters/block.hpp"

namespace waymark::importers {
namespace {

constexpr double kOffsetTolerance = 1000;  // m: archives round the radius of Mars to 3396000
constexpr double kHeightTolerance = 0.05;  // no body's relief above 500 km radius reaches that far

/// Lowest and highest known height of the first block that has any; low > high if there is none.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = kNoHeight;
};

Range heights_of_first_block(GDALDataset& dataset, const RasterHeader& header) {
  Range range;
  HeightScale unlimited = header.heights;  // distances from the centre are beyond all heights
  unlimited.min_height = -std::numeric_limits<double>::infinity();
  unlimited.max_height = std::numeric_limits<double>::infinity();
  const auto blocks = [](std::int64_t cells, int side) {
    return static_cast<int>((cells + side - 1) / side);
  };
  std::vector<double> row;
  for (int down = 0; down < blocks(header.rows, header.block_rows); ++down)
    for (int across = 0; across < blocks(header.columns, header.block_columns); ++across) {
      const Block block = read_block(dataset, header, across, down);
      const std::int64_t left = std::int64_t{across} * header.block_columns;
      const std::int64_t top = std::int64_t{down} * header.block_rows;
      row.resize(
          static_cast<std::size_t>(std::min<std::int64_t>(header.block_columns, header.columns - left)));
      for (std::int64_t r = 0; r < std::min<std::int64_t>(header.block_rows, header.rows - top); ++r) {
        std::ranges::fill(row, kNoHeight);
        copy_heights(block, static_cast<std::size_t>(r * header.block_columns), unlimited, row);
        for (const double height : row) {
          if (height == kNoHeight) continue;
          range.low = std::min(range.low, height);
          range.high = std::max(range.high, height);
        }
      }
      if (range.low <= range.high) return range;
    }
  return range;
}

// Returns the largest height that the band can hold.
double max_possible_height(const RasterHeader& header) {
  if (header.cells != CellType::int16) return std::numeric_limits<double>::infinity();
  return std::abs(header.heights.offset) + std::abs(header.heights.scale) * 32768;
}

}  // namespace

ReferenceRadius detect_reference_radius(GDALDataset& dataset, const RasterHeader& header) {
  const double radius = header.where.crs.body().equatorial_radius;
  if (!(radius > kOffsetTolerance)) return {};
  if (std::abs(header.heights.offset - radius) <= kOffsetTolerance)
    return {radius, fmt::format("the band's offset is {:.10g} m", header.heights.offset)};
  if (max_possible_height(header) < (1 - kHeightTolerance) * radius) return {};
  const auto [low, high] = heights_of_first_block(dataset, header);
  if (!(low <= high && low >= (1 - kHeightTolerance) * radius && high <= (1 + kHeightTolerance) * radius))
    return {};
  return {radius, fmt::format("the first ones are {:.10g} to {:.10g} m", low, high)};
}

}  // namespace waymark::importers
