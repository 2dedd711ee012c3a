// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
namespace waymark {

/// Side of the finest blocks, in cells.
inline constexpr std::int64_t kReliefBlock = 16;

/// The highest cell of each block that a tile touches; blocks are aligned to the whole grid, so a tile may
/// hold only part of one.
struct BlockRelief {
  Window blocks;                    ///< in blocks
  std::vector<double> highest;      ///< row by row
  std::vector<std::uint8_t> voids;  ///< 1: some cell has no height
};

/// `heights` is the window `owned` grown by one cell on each side.
BlockRelief block_relief(const HeightWindow& heights, const Window& owned);

/// Highest cells of ever larger blocks: level 0 has blocks of kReliefBlock cells, each next level twice that,
/// the last one block. About 0.05 bytes per cell of the grid.
class ReliefPyramid {
 public:
  ReliefPyramid() = default;
  /// Joins the tiles; each block is the maximum of its parts.
  ReliefPyramid(std::span<const std::shared_ptr<const BlockRelief>> tiles, std::int64_t columns,
                std::int64_t rows);

  struct Block {
    int level = 0;
    std::int64_t column = 0, row = 0;
  };
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
  /// Level 0 as if one tile had held the whole grid.
  BlockRelief finest() const;
  /// The cells of a block, cut to the grid.
  Window cells(const Block& b) const;

 private:
  void add_levels();

  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<Grid<double>> highest_;
  std::vector<Grid<std::uint8_t>> voids_;
};

}  // namespace waymark
