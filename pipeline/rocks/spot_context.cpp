// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/spot_context.hpp"

#include <algorithm>

#include "core/grid.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::int64_t kSquare = 96;  // pixels
constexpr std::size_t kFew = 12;      // spots

SpotContext context_of(std::vector<double>& peaks, double pixels) {
  SpotContext context;
  if (peaks.empty()) return context;
  const auto at = [&](double fraction) {
    const auto place = peaks.begin() + static_cast<std::ptrdiff_t>(fraction * double(peaks.size() - 1));
    std::nth_element(peaks.begin(), place, peaks.end());
    return *place;
  };
  context.median_peak = at(0.5);
  context.upper_decile = at(0.9);
  context.density = 1000 * double(peaks.size()) / std::max(1.0, pixels);
  return context;
}

}  // namespace

std::vector<SpotContext> spot_contexts(std::span<const DarkSpot> spots, std::int64_t columns,
                                       std::int64_t rows) {
  const std::int64_t across = std::max<std::int64_t>(1, (columns + kSquare - 1) / kSquare),
                     down = std::max<std::int64_t>(1, (rows + kSquare - 1) / kSquare);
  Grid<std::vector<double>> peaks(across, down);
  const auto square = [](double at, std::int64_t count) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(at) / kSquare, 0, count - 1);
  };
  std::vector<double> all;
  for (const DarkSpot& spot : spots) {
    peaks(square(spot.x, across), square(spot.y, down)).push_back(spot.peak);
    all.push_back(spot.peak);
  }
  const SpotContext whole = context_of(all, double(columns) * double(rows));
  Grid<SpotContext> contexts(across, down);
  for (std::int64_t row = 0; row < down; ++row)
    for (std::int64_t column = 0; column < across; ++column) {
      std::vector<double> near;
      std::int64_t pixels = 0;
      for (std::int64_t j = std::max<std::int64_t>(0, row - 1); j <= std::min(down - 1, row + 1); ++j)
        for (std::int64_t i = std::max<std::int64_t>(0, column - 1); i <= std::min(across - 1, column + 1);
             ++i) {
          near.insert(near.end(), peaks(i, j).begin(), peaks(i, j).end());
          pixels += std::min(kSquare, columns - i * kSquare) * std::min(kSquare, rows - j * kSquare);
        }
      contexts(column, row) = near.size() < kFew ? whole : context_of(near, double(pixels));
    }
  std::vector<SpotContext> result;
  for (const DarkSpot& spot : spots) result.push_back(contexts(square(spot.x, across), square(spot.y, down)));
  return result;
}

}  // namespace waymark::pipeline
