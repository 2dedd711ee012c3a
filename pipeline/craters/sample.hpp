// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include "geo/image_source.hpp"
namespace waymark {

/// Bilinear brightness at a place; beyond the edge that of the nearest pixel. The image is not empty.
inline float sample(const Pixels& image, double x, double y) {
  x = std::clamp(x, 0.0, double(image.columns() - 1));
  y = std::clamp(y, 0.0, double(image.rows() - 1));
  const auto column = static_cast<std::int64_t>(x), row = static_cast<std::int64_t>(y);
  const auto right = std::min(column + 1, image.columns() - 1), below = std::min(row + 1, image.rows() - 1);
  const auto a = static_cast<float>(x - double(column)), b = static_cast<float>(y - double(row));
  return (1 - b) * ((1 - a) * image(column, row) + a * image(right, row)) +
         b * ((1 - a) * image(column, below) + a * image(right, below));
}

}  // namespace waymark
