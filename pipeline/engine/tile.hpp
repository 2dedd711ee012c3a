// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::pipeline {

/// Rectangular part of the grid; a tile-scope stage runs once per tile.
struct Tile {
  std::int64_t index = 0;            ///< in row-major order of the tiling, from 0
  std::int64_t column = 0, row = 0;  ///< of the tiling
  Window cells;                      ///< tiles are disjoint and cover the grid
  std::int64_t rank = 0;             ///< order in which tiles run, and are divided into shards; no result
                                     ///< depends on it

  friend bool operator==(const Tile&, const Tile&) = default;
};

/// Returns the window grown by `halo` cells on every side; may reach outside the grid.
Window expand(const Window& window, std::int64_t halo);

/// Codec of the list of tiles of a job.
template <>
struct Codec<std::vector<Tile>> {
  static std::string encode(const std::vector<Tile>& tiles);
  static std::vector<Tile> decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
