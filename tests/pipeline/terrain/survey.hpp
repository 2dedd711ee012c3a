// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "pipeline/terrain/hidden_ground.hpp"
#include "pipeline/terrain/merge_trees.hpp"
#include "pipeline/terrain/prominence.hpp"
#include "pipeline/terrain/relief_pyramid.hpp"
#include "tests/support/dem_art.hpp"
namespace waymark::test {
using namespace pipeline;

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
  return std::make_shared<const DivideTree>(
      build_divide_tree(dem.read(grown), tile, dem.geometry(),
                        {.min_prominence = min_prominence, .hidden_above = hidden_above(dem)}));
}

/// Returns the summits of a DEM processed in square tiles of `side` cells.
inline std::vector<Summit> survey(const DemSource& dem, std::int64_t side, double min_prominence = 0,
                                  BasePolicy base = BasePolicy::sea) {
  std::vector<std::shared_ptr<const DivideTree>> trees;
  for (const Window& tile : tiles_of(dem.geometry(), side))
    trees.push_back(tree_of(dem, tile, min_prominence));
  return join_divide_trees(trees, min_prominence, base);
}

/// Returns the summits of a DEM whose tiles are merged by levels.
inline std::vector<Summit> survey_by_levels(const DemSource& dem, std::int64_t side,
                                            double min_prominence = 0, BasePolicy base = BasePolicy::sea) {
  TreePyramid levels(dem.geometry());
  for (const Window& tile : tiles_of(dem.geometry(), side)) levels.add(tree_of(dem, tile, min_prominence));
  const std::shared_ptr<const DivideTree> whole[] = {levels.whole()};
  return join_divide_trees(whole, min_prominence, base);
}

/// Returns the relief pyramid of a DEM, joined from square tiles of `side` cells.
inline ReliefPyramid pyramid_of(const DemSource& dem, std::int64_t side) {
  std::vector<std::shared_ptr<const BlockRelief>> tiles;
  for (const Window& t : tiles_of(dem.geometry(), side))
    tiles.push_back(std::make_shared<const BlockRelief>(
        block_relief(dem.read({t.column - 1, t.row - 1, t.columns + 2, t.rows + 2}), t, hidden_above(dem))));
  return {tiles, dem.geometry().columns, dem.geometry().rows};
}

}  // namespace waymark::test
