// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>
#include "pipeline/terrain/divide_tree.hpp"
namespace waymark::pipeline {

/// Merges the divide trees of neighbouring windows into that of `united`, which they fill without gap. The
/// result is the tree of a tile of that size: portals between the parts are replaced by their summits, border
/// cells inside are dropped, and summits that no other tile needs are pruned.
/// O(s + b log b) for s saddles and b border cells.
DivideTree merge_divide_trees(std::span<const std::shared_ptr<const DivideTree>> parts, const Window& united,
                              const GridGeometry& grid);

/// Merges the tiles of a grid by levels: 2 x 2 tiles, then 2 x 2 of these, up to the whole grid. A level
/// keeps about one row of groups, so memory grows with the width of the grid and the summits kept, not with
/// its area. Tiles are cut by tiles_of and come in its order.
class TreePyramid {
 public:
  explicit TreePyramid(const GridGeometry& grid) : grid_(grid) {}

  void add(std::shared_ptr<const DivideTree> tile);

  /// Returns the tree of the whole grid, or empty trees before the last tile was added.
  std::shared_ptr<const DivideTree> whole() const { return whole_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;  // row and column of a group on its level
  struct Group {
    std::vector<std::shared_ptr<const DivideTree>> parts;
  };
  std::int64_t side(int level) const { return side_ << level; }
  void add(int level, std::shared_ptr<const DivideTree> tree);

  const GridGeometry grid_;
  std::int64_t side_ = 0;                     // cells of a tile
  std::vector<std::map<Key, Group>> levels_;  // incomplete groups; level 1 holds 2 x 2 tiles
  std::shared_ptr<const DivideTree> whole_;
};

}  // namespace waymark::pipeline
