// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "geo/image_source.hpp"
#include "pipeline/rocks/shaded_ground.hpp"
namespace waymark::pipeline {

/// Fraction of each pixel in full shadow: alpha = (B - I) / (B - S), B the local ground, S the umbra. 0 is
/// as bright as the surrounding ground, 1 full shadow, below 0 brighter than the ground; clipped to [-1.5,
/// 1.3].
struct ShadowMap {
  Grid<float> alpha;    ///< 0 where there is no data or the surrounding ground is in shadow
  Grid<float> smooth;   ///< alpha filtered by (1 4 1) / 6 in both directions
  float umbra = 0;      ///< brightness of full shadow, in image values
  float noise = 0;      ///< standard deviation of pixel noise in alpha, median over the image
  Grid<float> texture;  ///< per tile: standard deviation of alpha over the ground
  int tile = 32;
  ShadedGround shaded;  ///< pixels in shadow, those of rocks too

  float texture_at(double x, double y) const;
};

/// Filters alpha by (1 4 1) / 6 in both directions; border pixels along the border alone. Values below -0.2
/// are raised to -0.2, so that a lit face does not hide the small shadow beside it.
Grid<float> smooth_alpha(const Grid<float>& alpha);

/// Computes the shadow map; `std::nullopt` if the contrast does not exceed the noise. `umbra`: brightness
/// of full shadow; finer scales pass theirs to coarser ones; unset: estimated.
std::optional<ShadowMap> map_shadows(const Pixels& image, int tile, std::optional<float> umbra = {});

/// Connected dark pixels of one shadow.
struct ShadowSegment {
  std::int32_t x = 0, y = 0;  ///< darkest pixel of the smoothed map
  float peak = 0;             ///< smoothed alpha there
  float base = 0;             ///< median of the smoothed map three to four pixels outside its dark core
  std::vector<std::int32_t>
      cells;  ///< row * columns + column, ascending: connected, above a fraction of peak over base
  std::size_t catchment_cells = 0;  ///< dark pixels of its whole catchment, including texture of the ground
};

struct SegmentLimits {
  float grow = 0.12F;  ///< pixels below belong to no shadow
  float seed = 0.2F;   ///< minimum of peak over base
  float merge =
      0.75F;  ///< two spots are joined if the saddle between them exceeds this fraction of the lesser peak
  float core = 0.5F;          ///< fraction of peak over base above which a pixel belongs to a shadow
  std::size_t max_cells = 0;  ///< larger segments are discarded; 0: no limit
};

/// Segments the smoothed map into catchments (steepest ascent), joined across shallow saddles, in order of
/// (y, x). Cost grows with the number of dark pixels.
std::vector<ShadowSegment> find_segments(const ShadowMap& map, const SegmentLimits& limits);

}  // namespace waymark::pipeline
