// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
namespace waymark {

/// What one tile knows of the summits and saddles of the whole grid: a maximum spanning forest of the basins
/// of steepest ascent, joined by saddle cells. The forests of all tiles together hold a maximum spanning
/// forest of the whole grid, so joining them is exact (join_divide_trees). Cells are indices of the whole
/// grid.
///
/// Where steepest ascent leaves the tile, the basin's summit is unknown here: a *portal* stands for it, the
/// first cell outside; the tile that owns that cell says in `border` where it leads.
struct DivideTree {
  struct Node {
    std::int64_t cell = 0;
    double height = 0;
    double contact = kNoHeight;  ///< highest cell of the basin beside hidden ground
    bool portal = false;
  };
  /// The highest cell through which nodes a and b are connected.
  struct Saddle {
    std::int64_t cell = 0;
    double height = 0;
    std::int32_t a = 0, b = 0;
  };
  struct Border {
    std::int64_t cell = 0;
    double height = 0;
    std::int32_t node = 0;
  };

  std::vector<Node> nodes;
  std::vector<Saddle> saddles;  ///< in the order of cell_order.hpp, highest first
  std::vector<Border> border;   ///< for each cell beside another tile: the summit or portal above it; by cell
  std::int64_t cells = 0;       ///< cells with a height
  std::int64_t maxima = 0;      ///< local maxima before any were pruned
  double min_prominence = 0;    ///< DivideTreeOptions::min_prominence
  double lowest = 0, highest = 0;  ///< of those; 0 where there are none
};

struct DivideTreeOptions {
  /// Summits that cannot reach this prominence are left out, with their saddles. Exact: the prominence within
  /// a tile is an upper bound of the true one. 0 keeps all.
  double min_prominence = 0;
  bool voids_hide_ground = false;  ///< no-data policies `unknown` and `fill`
};

/// The divide tree of the cells `owned`. `heights` is that window grown by one cell on each side.
/// Only critical cells are looked at closely: local maxima, and saddles, whose higher neighbours fall into
/// two or more connected parts (8-connectivity). All other cells cost one comparison with their neighbours.
/// O(cells) time, 4 bytes per cell of the tile.
DivideTree build_divide_tree(const HeightWindow& heights, const Window& owned, const GridGeometry& grid,
                             const DivideTreeOptions& options);

/// Contracts what cannot matter elsewhere; see DivideTreeOptions::min_prominence. With 0 it only drops the
/// saddles that close a cycle. Used by build_divide_tree; public for tests.
DivideTree prune(DivideTree tree, double min_prominence);

}  // namespace waymark
