// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/middle_of.hpp"

#include <algorithm>

namespace waymark::pipeline {

Pixels middle_of(const Pixels& image, std::int64_t side) {
  const std::int64_t columns = std::min(side, image.columns()), rows = std::min(side, image.rows());
  const std::int64_t x0 = (image.columns() - columns) / 2, y0 = (image.rows() - rows) / 2;
  Pixels middle(columns, rows);
  for (std::int64_t y = 0; y < rows; ++y)
    for (std::int64_t x = 0; x < columns; ++x) middle(x, y) = image(x0 + x, y0 + y);
  return middle;
}

}  // namespace waymark::pipeline
