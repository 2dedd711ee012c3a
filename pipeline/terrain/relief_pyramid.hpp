// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
#include "pipeline/terrain/neighbourhood.hpp"
namespace waymark::pipeline {

/// Side of the finest blocks, in cells.
inline constexpr std::int64_t kReliefBlock = 16;

/// Highest cell of each block that a tile intersects. Blocks are aligned to the whole grid, so a tile may
/// contain only part of one.
struct BlockRelief {
  Window blocks;                    ///< in blocks
  std::vector<double> highest;      ///< row by row
  std::vector<std::uint8_t> voids;  ///< 1: some cell has no height and hides terrain (is_hidden)
};

/// Returns whether a cell without height hides terrain: a neighbour is higher than `hidden_above`
/// (hidden_ground.hpp). `height(column, row)` returns cell heights.
bool is_hidden(std::int64_t column, std::int64_t row, double hidden_above, auto&& height) {
  if (hidden_above == kNoHeight) return true;
  for (const NeighbourStep step : kRing)
    if (height(column + step.column, row + step.row) > hidden_above) return true;
  return false;
}

/// Computes the relief of the cells `owned`. `heights` is that window grown by one cell on each side.
BlockRelief block_relief(const HeightWindow& heights, const Window& owned, double hidden_above);

/// Pyramid of highest cells: level 0 has blocks of kReliefBlock cells, each further level doubles them up to
/// a single block. Heights are rounded up to float: a block may be searched in vain, never left out. About
/// 0.03 bytes per cell of the grid.
class ReliefPyramid {
 public:
  ReliefPyramid() = default;
  /// Begins an empty pyramid: `add` every tile, then `build_levels`.
  ReliefPyramid(std::int64_t columns, std::int64_t rows);
  /// Adds a tile to level 0; each block is the maximum of its parts.
  void add(const BlockRelief& tile);
  /// Computes the further levels.
  void build_levels();
  /// Joins the tiles.
  ReliefPyramid(std::span<const std::shared_ptr<const BlockRelief>> tiles, std::int64_t columns,
                std::int64_t rows);

  /// Block of a level; levels count from the finest.
  struct Block {
    int level = 0;
    std::int64_t column = 0, row = 0;
  };
  /// Highest cell of a block, rounded up to float, and whether a height is unknown.
  struct Relief {
    double highest = kNoHeight;
    bool voids = false;
  };
  int levels() const { return static_cast<int>(highest_.size()); }
  Block top() const { return {levels() - 1, 0, 0}; }
  Relief operator()(const Block& b) const {
    const auto level = static_cast<std::size_t>(b.level);
    return {highest_[level](b.column, b.row), voids_[level](b.column, b.row) != 0};
  }
  bool contains(const Block& b) const {
    return highest_[static_cast<std::size_t>(b.level)].contains(b.column, b.row);
  }
  std::int64_t columns() const { return columns_; }  ///< of the grid, in cells
  std::int64_t rows() const { return rows_; }
  std::int64_t finest_columns() const { return highest_[0].columns(); }  ///< blocks
  std::int64_t finest_rows() const { return highest_[0].rows(); }
  /// Returns a row of blocks of level 0 as the relief of a tile of one row.
  BlockRelief finest_row(std::int64_t row) const;
  /// Returns the cells of a block, clipped to the grid.
  Window cells(const Block& b) const;

 private:
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<Grid<float>> highest_;
  std::vector<Grid<std::uint8_t>> voids_;
};

}  // namespace waymark::pipeline
