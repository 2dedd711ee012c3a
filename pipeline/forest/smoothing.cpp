// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/forest/canopy_window.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinSigma = 0.3;  // cells; below, a neighbour weighs less than 0.4 %

std::vector<float> kernel(double sigma, double cell) {
  const std::int64_t reach = smoothing_reach(sigma, cell);
  std::vector<float> weights(static_cast<std::size_t>(reach) + 1);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double away = static_cast<double>(i) * cell / sigma;
    weights[i] = static_cast<float>(std::exp(-away * away / 2));
  }
  return weights;
}

// into += weight * from, over a row. Sums run in the order of the taps, so results are the same in any
// window.
void add_row(std::span<float> into, std::span<const float> from, float weight) {
  for (std::size_t i = 0; i < into.size(); ++i) into[i] += weight * from[i];
}

struct Layers {
  Grid<float> heights, weights;
};

// Rows: each output row is a sum of shifted copies of its input row.
Layers along_rows(const Layers& in, const std::vector<float>& taps) {
  const std::int64_t columns = in.heights.columns(), rows = in.heights.rows();
  Layers out{Grid<float>(columns, rows), Grid<float>(columns, rows)};
  const auto reach = static_cast<std::int64_t>(taps.size()) - 1;
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t shift = -reach; shift <= reach; ++shift) {
      const std::int64_t first = std::max<std::int64_t>(0, -shift);
      const std::int64_t count = columns - std::abs(shift);
      if (count <= 0) continue;
      const float weight = taps[static_cast<std::size_t>(std::abs(shift))];
      const auto part = [&](auto row, std::int64_t start) {
        return row.subspan(static_cast<std::size_t>(start), static_cast<std::size_t>(count));
      };
      add_row(part(out.heights.row(r), first), part(in.heights.row(r), first + shift), weight);
      add_row(part(out.weights.row(r), first), part(in.weights.row(r), first + shift), weight);
    }
  return out;
}

Layers along_columns(const Layers& in, const std::vector<float>& taps) {
  const std::int64_t columns = in.heights.columns(), rows = in.heights.rows();
  Layers out{Grid<float>(columns, rows), Grid<float>(columns, rows)};
  const auto reach = static_cast<std::int64_t>(taps.size()) - 1;
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t shift = -reach; shift <= reach; ++shift) {
      if (r + shift < 0 || r + shift >= rows) continue;
      const float weight = taps[static_cast<std::size_t>(std::abs(shift))];
      add_row(out.heights.row(r), in.heights.row(r + shift), weight);
      add_row(out.weights.row(r), in.weights.row(r + shift), weight);
    }
  return out;
}

}  // namespace

std::int64_t smoothing_reach(double sigma, double cell) {
  if (!(sigma >= kMinSigma * cell)) return 0;
  return static_cast<std::int64_t>(std::ceil(3 * sigma / cell));
}

CanopyWindow smooth_canopy(const CanopyWindow& canopy, double sigma) {
  const auto across = kernel(sigma, canopy.cell_width), down = kernel(sigma, canopy.cell_height);
  if (across.size() == 1 && down.size() == 1) return canopy;
  Layers layers{canopy.heights, Grid<float>(canopy.heights.columns(), canopy.heights.rows(), 1)};
  const auto heights = layers.heights.cells();
  const auto weights = layers.weights.cells();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const bool known = heights[i] != kNoCanopy;
    weights[i] = known ? 1.0F : 0.0F;
    heights[i] = known ? heights[i] : 0.0F;
  }
  layers = along_columns(along_rows(layers, across), down);
  CanopyWindow out = canopy;
  const auto raw = canopy.heights.cells();
  const auto result = out.heights.cells();
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = raw[i] == kNoCanopy ? kNoCanopy : layers.heights.cells()[i] / layers.weights.cells()[i];
  return out;
}

}  // namespace waymark::pipeline
