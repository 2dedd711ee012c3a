// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
namespace waymark::pipeline {

/// Divide tree of one tile: a maximum spanning forest of the basins of steepest ascent, joined by saddle
/// cells.
/// The forests of all tiles together contain a maximum spanning forest of the whole grid, so joining them is
/// exact (join_divide_trees). Cells are indices of the whole grid.
///
/// If steepest ascent leaves the tile, a *portal*, the first cell outside, stands for the unknown summit of
/// the basin. The tile that owns this cell gives its summit in `border`.
struct DivideTree {
  /// Summit, or a portal.
  struct Node {
    std::int64_t cell = 0;
    double height = 0;
    double contact = kNoHeight;  ///< highest cell of the basin next to unknown terrain
    bool portal = false;
  };
  /// Highest cell that connects nodes a and b.
  struct Saddle {
    std::int64_t cell = 0;
    double height = 0;
    std::int32_t a = 0, b = 0;
  };
  /// Cell next to another tile, with its summit or portal.
  struct Border {
    std::int64_t cell = 0;
    double height = 0;
    std::int32_t node = 0;
  };

  /// Cells of the tile that hold no height of the files, and what became of them.
  struct Voids {
    std::int64_t empty = 0;  ///< without a height, after filling
    std::int64_t rim = 0;    ///< cells with a height beside an empty one that hides terrain
    CellFaults faults;

    Voids& operator+=(const Voids& other);
  };

  Window window;  ///< cells of the tile
  std::vector<Node> nodes;
  std::vector<Saddle> saddles;     ///< in the order of cell_order.hpp, highest first
  std::vector<Border> border;      ///< for each cell next to another tile: its summit or portal; by cell
  std::int64_t cells = 0;          ///< cells with a height
  std::int64_t maxima = 0;         ///< local maxima before pruning
  double min_prominence = 0;       ///< DivideTreeOptions::min_prominence
  double lowest = 0, highest = 0;  ///< height of those cells; 0 if there are none
  Voids voids;                     ///< `faults` is set by the caller of build_divide_tree
};

/// Options of a divide tree.
struct DivideTreeOptions {
  /// Summits that cannot reach this prominence are pruned with their saddles; 0 keeps all.
  /// Exact, since the prominence within a tile is an upper bound of the true one.
  double min_prominence = 0;
  /// A void beside a cell above this hides terrain (hidden_ground.hpp); +infinity: no void does.
  double hidden_above = std::numeric_limits<double>::infinity();
};

/// Builds the divide tree of the cells `owned`. O(cells) time, 4 bytes per cell of the tile.
/// - `heights` is that window grown by one cell on each side.
/// - Critical cells are local maxima and saddles, whose higher neighbours form two or more connected parts
///   (8-connectivity). Other cells cost one comparison with their neighbours.
DivideTree build_divide_tree(const HeightWindow& heights, const Window& owned, const GridGeometry& grid,
                             const DivideTreeOptions& options);

/// Contracts summits that other tiles do not need; see DivideTreeOptions::min_prominence. With 0 it only
/// drops saddles that close a cycle.
/// Used by build_divide_tree; public for tests.
DivideTree prune(DivideTree tree, double min_prominence);

}  // namespace waymark::pipeline
