// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Brightness of the local ground and its spread, per tile.
struct LocalBackground {
  int tile = 32;       ///< side of a tile, pixels
  Grid<float> level;   ///< median brightness of the tile and its surroundings; NaN: no data nearby
  Grid<float> spread;  ///< robust standard deviation (1.4826 x median absolute deviation) about that level
  std::int64_t columns = 0, rows = 0;  ///< of the image

  /// Pixels [begin, end) of each row between the same two tile centres, `tile` the left one.
  struct Run {
    std::int64_t tile = 0, begin = 0, end = 0;
  };
  std::vector<Run> runs;
  std::vector<float> fraction;  ///< of each pixel of a row: position between its tile centres, [0, 1]

  /// Interpolates level and spread of one image row between tile centres; the spread only if `spread_out`
  /// is not empty.
  void read_row(std::int64_t row, std::span<float> level_out, std::span<float> spread_out) const;
  /// Returns the spread at one pixel, the same as in read_row.
  float spread_at(std::int64_t column, std::int64_t row) const;
};

/// Computes medians over overlapping windows two tiles wide, subsampled. Objects smaller than about a tile
/// do not affect the level. NaN pixels are ignored. About 10 ns per pixel.
LocalBackground local_background(const Pixels& image, int tile);

/// Returns the standard deviation of pixel noise from the median of second differences (after Immerkaer
/// 1996, made robust); smooth texture contributes little. 0 for an image below 3 x 3 pixels.
float noise_sd(const Pixels& image);

}  // namespace waymark::pipeline
