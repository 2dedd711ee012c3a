// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "geo/image_source.hpp"
namespace waymark {

/// What the ground around each place looks like: brightness and its spread, tile by tile.
struct LocalBackground {
  int tile = 32;       ///< pixels per side of a tile
  Grid<float> level;   ///< median brightness of the tile and its surroundings; NaN: no data anywhere near
  Grid<float> spread;  ///< robust standard deviation (1.4826 x median absolute deviation) about that level
  std::int64_t columns = 0, rows = 0;  ///< of the image

  /// Level and spread of one image row, interpolated between tile centres; the spread only where there is
  /// room for it.
  void read_row(std::int64_t row, std::span<float> level_out, std::span<float> spread_out) const;
};

/// Medians of overlapping windows of two tiles' width, of every third row and column's worth of pixels.
/// Things smaller than about a tile do not enter the level. NaN pixels are ignored. About 10 ns per pixel.
LocalBackground local_background(const Pixels& image, int tile);

/// Standard deviation of pixel noise, from the median of second differences (in the manner of Immerkaer 1996,
/// but robust): texture of the ground counts as little as it is smooth. 0 for an image of under 9 pixels.
float noise_sd(const Pixels& image);

}  // namespace waymark
