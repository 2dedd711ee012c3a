// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "testbed/render.hpp"
namespace waymark {

/// Which rocks, and which rocks' shadows, each square of a picture may show.
struct RockTiles {
  static constexpr std::int64_t kSide = 16;  ///< pixels

  struct Tile {
    std::vector<std::uint32_t> rocks, shadows;  ///< indices into Scene::solids
  };
  Grid<Tile> tiles;
  Grid<std::uint8_t> busy;  ///< per pixel: a rock or its shadow is near, so it wants several samples
};

/// Rocks whose outline is narrower than `smallest` pixels are left out.
RockTiles sort_rocks(const Scene& scene, const View& view, const Sun& sun, double smallest);

}  // namespace waymark
