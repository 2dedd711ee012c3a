// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/local_maxima.hpp"

#include <limits>

namespace waymark::pipeline {
namespace {

constexpr float kNone = -std::numeric_limits<float>::infinity();

bool is_maximum_slowly(const Grid<float>& heights, std::int64_t column, std::int64_t row) {
  const float here = heights(column, row);
  if (here == kNone) return false;
  for (std::size_t i = 0; i < kNeighbours.size(); ++i) {
    const std::int64_t c = column + kNeighbours[i].column, r = row + kNeighbours[i].row;
    if (!heights.contains(c, r)) continue;
    if (i < 4 ? heights(c, r) >= here : heights(c, r) > here) return false;
  }
  return true;
}

}  // namespace

void local_maxima(const Grid<float>& heights, std::int64_t first, std::int64_t row,
                  std::span<std::uint8_t> is_maximum) {
  const auto count = static_cast<std::int64_t>(is_maximum.size());
  const bool inside = row > 0 && row + 1 < heights.rows() && count > 2;
  const std::int64_t from = inside && first == 0 ? 1 : 0;
  const std::int64_t to = inside ? (first + count == heights.columns() ? count - 1 : count) : 0;
  if (inside) {
    const float* north = heights.row(row - 1).data() + first;
    const float* here = heights.row(row).data() + first;
    const float* south = heights.row(row + 1).data() + first;
    std::uint8_t* out = is_maximum.data();
    for (std::int64_t i = from; i < to; ++i) {
      const float h = here[i];
      out[i] = static_cast<std::uint8_t>((h > north[i - 1]) & (h > north[i]) & (h > north[i + 1]) &
                                         (h > here[i - 1]) & (h >= here[i + 1]) & (h >= south[i - 1]) &
                                         (h >= south[i]) & (h >= south[i + 1]));
    }
  }
  for (std::int64_t i = 0; i < count; ++i)
    if (!inside || i < from || i >= to)
      is_maximum[static_cast<std::size_t>(i)] = is_maximum_slowly(heights, first + i, row) ? 1 : 0;
}

}  // namespace waymark::pipeline
