// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/craters/tile_spectrum.hpp"
namespace waymark {

/// Sums over all cells above and to the left, of a tile's values and of their squares: kTileSide + 1 rows
/// and columns, the first of either zero.
struct TileSums {
  explicit TileSums(std::span<const float> tile);
  static constexpr int kSide = kTileSide + 1;
  std::vector<double> values, squares;
};

/// The greater of two at each cell, in `values`.
void raise(std::span<float> values, std::span<const float> others);

/// Responses of a template of zero mean and norm 1 and of 2 half + 1 cells a side become, at the cells
/// `margin` or more from the tile's edge, squares of its normalised correlation, with their sign: the square
/// of the response over (sum of squared deviations under the template + `floor`). Of two templates the
/// greater, where there are `others`. margin > half, kTileSide - 2 margin at least 8.
void normalise(std::span<float> responses, std::span<const float> others, const TileSums& sums, int half,
               int margin, double floor);

}  // namespace waymark
