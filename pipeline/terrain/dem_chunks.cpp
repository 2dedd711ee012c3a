// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/dem_chunks.hpp"

#include <algorithm>

namespace waymark::pipeline {

const HeightWindow& DemChunks::fetch(std::int64_t column, std::int64_t row) {
  const GridGeometry& grid = dem_.geometry();
  const std::int64_t key = row * (grid.columns / kSide + 1) + column;
  auto& chunk = chunks_[key];
  if (!chunk) {
    const Window cells{column * kSide, row * kSide, std::min(kSide, grid.columns - column * kSide),
                       std::min(kSide, grid.rows - row * kSide)};
    chunk = std::make_unique<HeightWindow>(dem_.read(cells));
    age_.push_back(key);
  }
  current_ = chunk.get();
  current_column_ = column;
  current_row_ = row;
  if (age_.size() > limit_) {  // never the newest: limit_ >= 1
    chunks_.erase(age_.front());
    age_.pop_front();
  }
  return *current_;
}

}  // namespace waymark::pipeline
