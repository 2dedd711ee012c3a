// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "pipeline/terrain/prominence.hpp"
#include "pipeline/terrain/relief_pyramid.hpp"
#include "tests/support/dem_art.hpp"
namespace waymark::testing {

inline std::vector<Window> tiles_of(const GridGeometry& grid, std::int64_t side) {
  std::vector<Window> tiles;
  for (std::int64_t r = 0; r < grid.rows; r += side)
    for (std::int64_t c = 0; c < grid.columns; c += side)
      tiles.push_back({c, r, std::min(side, grid.columns - c), std::min(side, grid.rows - r)});
  return tiles;
}

inline std::shared_ptr<const DivideTree> tree_of(const DemSource& dem, const Window& tile,
                                                 double min_prominence) {
  const Window grown{tile.column - 1, tile.row - 1, tile.columns + 2, tile.rows + 2};
  return std::make_shared<const DivideTree>(build_divide_tree(
      dem.read(grown), tile, dem.geometry(),
      {.min_prominence = min_prominence, .voids_hide_ground = dem.nodata_policy() != NodataPolicy::ocean}));
}

/// The summits of a DEM worked off in square tiles of `side` cells.
inline std::vector<Summit> survey(const DemSource& dem, std::int64_t side, double min_prominence = 0,
                                  BasePolicy base = BasePolicy::sea) {
  std::vector<std::shared_ptr<const DivideTree>> trees;
  for (const Window& tile : tiles_of(dem.geometry(), side))
    trees.push_back(tree_of(dem, tile, min_prominence));
  return join_divide_trees(trees, min_prominence, base);
}

/// The highest cells of a DEM, gathered from square tiles of `side` cells.
inline ReliefPyramid pyramid_of(const DemSource& dem, std::int64_t side) {
  std::vector<std::shared_ptr<const BlockRelief>> tiles;
  for (const Window& t : tiles_of(dem.geometry(), side))
    tiles.push_back(std::make_shared<const BlockRelief>(
        block_relief(dem.read({t.column - 1, t.row - 1, t.columns + 2, t.rows + 2}), t)));
  return {tiles, dem.geometry().columns, dem.geometry().rows};
}

}  // namespace waymark::testing
