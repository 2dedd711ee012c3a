// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/relief_pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::pipeline {
namespace {

constexpr float kNone = static_cast<float>(kNoHeight);

std::int64_t blocks_for(std::int64_t cells) {
  return (cells + kReliefBlock - 1) / kReliefBlock;
}

float rounded_up(double height) {
  const auto near = static_cast<float>(height);
  return static_cast<double>(near) < height ? std::nextafter(near, std::numeric_limits<float>::infinity())
                                            : near;
}

}  // namespace

BlockRelief block_relief(const HeightWindow& heights, const Window& owned, double hidden_above) {
  BlockRelief relief;
  relief.blocks.column = owned.column / kReliefBlock;
  relief.blocks.row = owned.row / kReliefBlock;
  relief.blocks.columns = blocks_for(owned.end_column()) - relief.blocks.column;
  relief.blocks.rows = blocks_for(owned.end_row()) - relief.blocks.row;
  relief.highest.assign(static_cast<std::size_t>(relief.blocks.cells()), kNoHeight);
  relief.voids.assign(static_cast<std::size_t>(relief.blocks.cells()), 0);
  for (std::int64_t r = 0; r < owned.rows; ++r) {
    const std::int64_t block_row = (owned.row + r) / kReliefBlock - relief.blocks.row;
    const auto cells = heights.row(r + 1).subspan(1, static_cast<std::size_t>(owned.columns));
    for (std::int64_t b = 0; b < relief.blocks.columns; ++b) {
      const std::int64_t first = (relief.blocks.column + b) * kReliefBlock - owned.column;
      const auto from = static_cast<std::size_t>(std::max<std::int64_t>(first, 0));
      const auto to = static_cast<std::size_t>(std::min(first + kReliefBlock, owned.columns));
      const auto at = static_cast<std::size_t>(block_row * relief.blocks.columns + b);
      for (std::size_t c = from; c < to; ++c) {
        relief.highest[at] = std::max(relief.highest[at], cells[c]);
        if (cells[c] == kNoHeight && !relief.voids[at] &&
            is_hidden(static_cast<std::int64_t>(c) + 1, r + 1, hidden_above, heights))
          relief.voids[at] = 1;
      }
    }
  }
  return relief;
}

ReliefPyramid::ReliefPyramid(std::span<const std::shared_ptr<const BlockRelief>> tiles, std::int64_t columns,
                             std::int64_t rows)
    : ReliefPyramid(columns, rows) {
  for (const auto& tile : tiles) add(*tile);
  build_levels();
}

ReliefPyramid::ReliefPyramid(std::int64_t columns, std::int64_t rows) : columns_(columns), rows_(rows) {
  highest_.emplace_back(blocks_for(columns), blocks_for(rows), kNone);
  voids_.emplace_back(blocks_for(columns), blocks_for(rows), std::uint8_t{0});
}

void ReliefPyramid::add(const BlockRelief& tile) {
  for (std::int64_t r = 0; r < tile.blocks.rows; ++r)
    for (std::int64_t c = 0; c < tile.blocks.columns; ++c) {
      const auto at = static_cast<std::size_t>(r * tile.blocks.columns + c);
      float& highest = highest_[0](tile.blocks.column + c, tile.blocks.row + r);
      highest = std::max(highest, rounded_up(tile.highest[at]));
      voids_[0](tile.blocks.column + c, tile.blocks.row + r) |= tile.voids[at];
    }
}

void ReliefPyramid::build_levels() {
  while (highest_.back().columns() > 1 || highest_.back().rows() > 1) {
    const auto& fine = highest_.back();
    const auto& fine_voids = voids_.back();
    Grid<float> coarse((fine.columns() + 1) / 2, (fine.rows() + 1) / 2, kNone);
    Grid<std::uint8_t> coarse_voids(coarse.columns(), coarse.rows(), std::uint8_t{0});
    for (std::int64_t r = 0; r < fine.rows(); ++r)
      for (std::int64_t c = 0; c < fine.columns(); ++c) {
        coarse(c / 2, r / 2) = std::max(coarse(c / 2, r / 2), fine(c, r));
        coarse_voids(c / 2, r / 2) |= fine_voids(c, r);
      }
    highest_.push_back(std::move(coarse));
    voids_.push_back(std::move(coarse_voids));
  }
}

BlockRelief ReliefPyramid::finest_row(std::int64_t row) const {
  const std::int64_t columns = highest_[0].columns();
  BlockRelief one{{0, row, columns, 1}, {}, {}};
  for (std::int64_t c = 0; c < columns; ++c) {
    one.highest.push_back(static_cast<double>(highest_[0](c, row)));
    one.voids.push_back(voids_[0](c, row));
  }
  return one;
}

Window ReliefPyramid::cells(const Block& b) const {
  const std::int64_t side = kReliefBlock << b.level;
  Window cells{b.column * side, b.row * side, side, side};
  cells.columns = std::min(side, columns_ - cells.column);
  cells.rows = std::min(side, rows_ - cells.row);
  return cells;
}

}  // namespace waymark::pipeline
