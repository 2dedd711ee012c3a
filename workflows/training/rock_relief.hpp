// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>
#include "workflows/training/rock_scene.hpp"
namespace waymark::workflows {

/// Height field of a scene of rocks, several samples per pixel. Lengths and heights are pixels of its image.
struct RockRelief {
  static constexpr int kSamples = 4;           ///< per pixel and direction
  static constexpr std::int64_t kMargin = 48;  ///< pixels beyond the image, which cast shadows into it

  /// Makes level terrain about an image of this size, pixels.
  RockRelief(std::int64_t image_columns, std::int64_t image_rows)
      : columns((image_columns + 2 * kMargin) * kSamples),
        rows((image_rows + 2 * kMargin) * kSamples),
        heights(static_cast<std::size_t>(columns * rows)) {}

  /// Returns the pixel coordinate of the centre of a sample; whole numbers are centres of pixels.
  static double pixel(std::int64_t sample) {
    return (static_cast<double>(sample) + 0.5) / kSamples - 0.5 - static_cast<double>(kMargin);
  }
  float& operator()(std::int64_t column, std::int64_t row) {
    return heights[static_cast<std::size_t>(row * columns + column)];
  }
  float operator()(std::int64_t column, std::int64_t row) const {
    return heights[static_cast<std::size_t>(row * columns + column)];
  }

  std::int64_t columns = 0, rows = 0;  ///< samples, margins included
  std::vector<float> heights;
  std::vector<TrueRockInImage> rocks;  ///< largest first
};

/// Makes the terrain of a scene: slope, roughness, dunes, craters and rocks. The same scene gives the same
/// relief.
RockRelief make_rock_relief(const RockScene& scene);

}  // namespace waymark::workflows
