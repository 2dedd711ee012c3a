// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace waymark::pipeline {

/// Dark spot that could be the shadow of a rock.
struct DarkSpot {
  double x = 0, y = 0;  ///< pixels
  double peak = 0;      ///< shadow fraction of its darkest pixel, above its surroundings
};

/// Statistics of the dark spots about a position. Terrain whose texture resembles small shadows is full of
/// similar spots; a rock on it is darker.
struct SpotContext {
  double median_peak = 0;   ///< median peak
  double upper_decile = 0;  ///< 90th percentile of the peaks
  double density = 0;       ///< spots per 1000 pixels
};

/// Returns the context of each spot over the 3 x 3 squares of 96 pixels about it; over all spots if these
/// hold fewer than 12. O(n), and 27 peaks per spot for evenly spread ones.
std::vector<SpotContext> spot_contexts(std::span<const DarkSpot> spots, std::int64_t columns,
                                       std::int64_t rows);

}  // namespace waymark::pipeline
