// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "workflows/training/rough_forest.hpp"
namespace waymark::test {
using workflows::SyntheticCanopy;

/// Returns rounded cones with random positions, heights and widths, rough bark, some ground and holes.
inline SyntheticCanopy synthetic_forest(std::uint64_t seed, std::int64_t side, int trees, double cell = 0.5) {
  Random random(seed, "made_forest");
  Grid<float> heights(side, side, 0);
  for (int t = 0; t < trees; ++t) {
    const double x = random.uniform() * static_cast<double>(side),
                 y = random.uniform() * static_cast<double>(side);
    const double top = 4 + 26 * random.uniform(), radius = (0.8 + 0.12 * top) / cell;
    for (std::int64_t r = 0; r < side; ++r)
      for (std::int64_t c = 0; c < side; ++c) {
        const double away = std::hypot(static_cast<double>(c) - x, static_cast<double>(r) - y) / radius;
        if (away < 1)
          heights(c, r) = std::max(heights(c, r), static_cast<float>(top * (1 - 0.7 * away * away)));
      }
  }
  for (float& h : heights.cells()) {
    if (h > 0) h = std::max(0.0F, h + static_cast<float>(1.2 * (random.uniform() - 0.5)));
    if (random.uniform() < 0.002) h = kNoCanopy;
  }
  return {std::move(heights), cell};
}

}  // namespace waymark::test
