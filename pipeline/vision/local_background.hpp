// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Brightness of the local ground and its spread, per tile.
struct LocalBackground {
  int tile = 32;       ///< side of a tile, pixels
  Grid<float> level;   ///< median brightness of the tile and its surroundings; NaN: no data nearby
  Grid<float> spread;  ///< robust standard deviation (1.4826 x median absolute deviation) about that level
  std::int64_t columns = 0, rows = 0;  ///< of the image

  /// Interpolates level and spread of one image row between tile centres; the spread only if `spread_out`
  /// is not empty.
  void read_row(std::int64_t row, std::span<float> level_out, std::span<float> spread_out) const;
};

/// Computes medians over overlapping windows two tiles wide, subsampled. Objects smaller than about a tile
/// do not affect the level. NaN pixels are ignored. About 10 ns per pixel.
LocalBackground local_background(const Pixels& image, int tile);

/// Returns the standard deviation of pixel noise from the median of second differences (after Immerkaer
/// 1996, made robust); smooth texture contributes little. 0 for an image below 3 x 3 pixels.
float noise_sd(const Pixels& image);

}  // namespace waymark::pipeline
