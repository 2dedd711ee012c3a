// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace waymark {

/// A dark spot that could be a rock's shadow.
struct DarkSpot {
  double x = 0, y = 0;  ///< pixels
  double peak = 0;      ///< shadow fraction of its darkest pixel, above its surroundings
};

/// What else is dark about a place. Ground whose texture passes for small shadows is full of spots that are
/// alike; a rock on it is darker than they.
struct SpotContext {
  double usual = 0;    ///< median of the peaks
  double deep = 0;     ///< a tenth of the peaks are above this
  double crowded = 0;  ///< spots per 1000 pixels
};

/// Of each spot, over the 3 x 3 squares of 96 pixels about it; of all spots where fewer than 12 lie there.
/// O(n) and 27 peaks looked at per spot of evenly spread ones.
std::vector<SpotContext> spot_contexts(std::span<const DarkSpot> spots, std::int64_t columns,
                                       std::int64_t rows);

}  // namespace waymark
