// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Returns the bilinearly interpolated brightness; beyond the edge that of the nearest pixel. The image is
/// not empty.
inline float sample(const Pixels& image, double x, double y) {
  x = std::clamp(x, 0.0, double(image.columns() - 1));
  y = std::clamp(y, 0.0, double(image.rows() - 1));
  const auto column = static_cast<std::int64_t>(x), row = static_cast<std::int64_t>(y);
  const auto right = std::min(column + 1, image.columns() - 1), below = std::min(row + 1, image.rows() - 1);
  const auto a = static_cast<float>(x - double(column)), b = static_cast<float>(y - double(row));
  return (1 - b) * ((1 - a) * image(column, row) + a * image(right, row)) +
         b * ((1 - a) * image(column, below) + a * image(right, below));
}

/// Samples as sample() does, for a position strictly inside: [0, columns - 1) x [0, rows - 1).
inline float sample_inside(const float* pixels, std::int64_t columns, double x, double y) {
  const auto column = static_cast<int>(x), row = static_cast<int>(y);
  const auto a = static_cast<float>(x - column), b = static_cast<float>(y - row);
  const float* p = pixels + row * columns + column;
  return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * p[columns] + a * p[columns + 1]);
}

/// Returns whether all positions within `reach` of (x, y) along either axis are valid for sample_inside().
inline bool is_inside(const Pixels& image, double x, double y, double reach) {
  return x - reach >= 0 && y - reach >= 0 && x + reach < double(image.columns() - 1) &&
         y + reach < double(image.rows() - 1);
}

}  // namespace waymark::pipeline
