// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "geo/image_source.hpp"
namespace waymark {

/// How much of each pixel lies in full shadow: alpha = (B - I) / (B - S), B the local ground, S the umbra.
/// 0 is ground like that around it, 1 full shadow, below 0 brighter than the ground; clipped to [-1.5, 1.3].
struct ShadowMap {
  Grid<float> alpha;    ///< 0 where there is no data or the ground around is itself in shadow
  Grid<float> smooth;   ///< alpha under the mask (1 4 1) / 6 both ways
  float umbra = 0;      ///< brightness of full shadow, in the image's numbers
  float noise = 0;      ///< standard deviation of pixel noise in alpha, median over the image
  Grid<float> texture;  ///< per tile: spread of alpha over the ground
  int tile = 32;

  float texture_at(double x, double y) const;
};

/// The mask (1 4 1) / 6 both ways; of alpha from -0.2 up, so that a lit face does not blot out
/// the small shadow beside it; border pixels are smoothed along the border alone.
Grid<float> smoothed(const Grid<float>& alpha);

/// What is needed to tell the umbra from the ground; finer scales hand theirs to the coarser.
/// Nothing where the image has no contrast beyond its noise.
std::optional<ShadowMap> map_shadows(const Pixels& image, int tile, std::optional<float> umbra = {});

/// The connected dark pixels of one shadow.
struct ShadowSegment {
  std::int32_t x = 0, y = 0;  ///< darkest pixel (of the smoothed map)
  float peak = 0;             ///< smoothed alpha there
  float base = 0;             ///< median of the smoothed map three to four pixels beyond its dark middle
  std::vector<std::int32_t>
      cells;  ///< row * columns + column: connected, above a share of peak over base, ascending
  std::size_t surroundings = 0;  ///< dark pixels of its whole catchment, texture of the ground included
};

struct SegmentLimits {
  float grow = 0.12F;   ///< pixels below do not belong to any shadow
  float seed = 0.2F;    ///< shadows whose peak is less above their base are left out
  float merge = 0.75F;  ///< two darks are one where the pass between them is above this share of the lesser
  float core = 0.5F;    ///< share of peak over base above which a pixel belongs to a shadow
  std::size_t most_cells = 0;  ///< larger segments are left out; 0: no limit
};

/// Catchments of the smoothed map (steepest ascent), joined across shallow passes, in order of (y, x).
/// Cost grows with the number of dark pixels.
std::vector<ShadowSegment> find_segments(const ShadowMap& map, const SegmentLimits& limits);

}  // namespace waymark
