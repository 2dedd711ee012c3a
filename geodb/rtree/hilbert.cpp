// SPDX-License-Identifier: Apache-2.0
#include "geodb/rtree/hilbert.hpp"

#include <utility>

namespace waymark::geodb {

std::uint32_t hilbert_index(std::uint16_t column, std::uint16_t row) {
  std::uint32_t x = column, y = row, index = 0;
  for (std::uint32_t side = 1u << 15; side > 0; side >>= 1) {
    const std::uint32_t right = (x & side) != 0, up = (y & side) != 0;
    index = index << 2 | ((3 * right) ^ up);
    if (up) continue;  // the two lower quadrants are reflected
    if (right) {
      x = ~x;
      y = ~y;
    }
    std::swap(x, y);
  }
  return index;
}

}  // namespace waymark::geodb
