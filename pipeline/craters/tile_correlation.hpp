// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/craters/tile_spectrum.hpp"
namespace waymark::pipeline {

/// Summed-area tables of the values of a tile and of their squares: kTileSide + 1 rows and columns, the
/// first of each zero.
struct TileSums {
  explicit TileSums(std::span<const float> tile);
  static constexpr int kSide = kTileSide + 1;
  std::vector<double> values, squares;
};

/// Stores the greater of two values of each cell in `values`.
void take_maximum(std::span<float> values, std::span<const float> others);

/// Replaces template responses by the squares of the normalised correlation, with their sign, at cells
/// `margin` or more from the edge of the tile.
/// - The template has zero mean, norm 1 and 2 half + 1 cells a side.
/// - The result is the squared response over (sum of squared deviations under the template + `floor`).
/// - Takes the greater of two templates if `others` is not empty.
/// - Requires margin > half and kTileSide - 2 margin >= 8.
void normalise(std::span<float> responses, std::span<const float> others, const TileSums& sums, int half,
               int margin, double floor);

}  // namespace waymark::pipeline
