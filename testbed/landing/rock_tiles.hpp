// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "testbed/render.hpp"
namespace waymark::testbed {

/// Rocks and rock shadows that may be visible in each square of an image.
struct RockTiles {
  static constexpr std::int64_t kSide = 16;  ///< pixels

  struct Tile {
    std::vector<std::uint32_t> rocks, shadows;  ///< indices into Scene::solids
  };
  Grid<Tile> tiles;
  Grid<std::uint8_t> busy;  ///< per pixel: near a rock or its shadow, so it is supersampled
};

/// Discards rocks whose outline is narrower than `smallest` pixels.
RockTiles bin_rocks(const Scene& scene, const View& view, const Sun& sun, double smallest);

}  // namespace waymark::testbed
