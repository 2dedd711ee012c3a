// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include "geo/dem_source.hpp"
namespace waymark::pipeline {

/// Random access to the cells of a DEM through a cache of squares of 64 cells; the oldest are dropped. For
/// one thread.
/// The squares are small because a search reads few scattered blocks.
class DemChunks {
 public:
  static constexpr std::int64_t kSide = 64;

  /// Caches at most `limit` chunks of 32 KiB.
  explicit DemChunks(const DemSource& dem, std::size_t limit = 256) : dem_(dem), limit_(limit) {}

  /// Returns the height of a cell; kNoHeight outside the grid. Columns wrap around if the grid does.
  double operator()(std::int64_t column, std::int64_t row) {
    const GridGeometry& grid = dem_.geometry();
    if (grid.wraps) column = (column + grid.columns) % grid.columns;
    if (column < 0 || column >= grid.columns || row < 0 || row >= grid.rows) return kNoHeight;
    return chunk(column / kSide, row / kSide)(column % kSide, row % kSide);
  }
  const HeightWindow& chunk(std::int64_t column, std::int64_t row) {
    if (current_ && column == current_column_ && row == current_row_) return *current_;
    return fetch(column, row);
  }

 private:
  const HeightWindow& fetch(std::int64_t column, std::int64_t row);

  const DemSource& dem_;
  std::size_t limit_;
  std::unordered_map<std::int64_t, std::unique_ptr<HeightWindow>> chunks_;
  std::deque<std::int64_t> age_;
  const HeightWindow* current_ = nullptr;
  std::int64_t current_column_ = -1, current_row_ = -1;
};

}  // namespace waymark::pipeline
