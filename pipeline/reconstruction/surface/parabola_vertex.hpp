// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
namespace waymark::pipeline {

/// Returns the vertex of the parabola through three scores of equal spacing, in steps from the middle one; 0
/// without a maximum. Between -0.5 and 0.5.
inline double parabola_vertex(float before, float middle, float after) {
  const double bend =
      static_cast<double>(before) - 2 * static_cast<double>(middle) + static_cast<double>(after);
  if (!(bend < 0)) return 0;
  return std::clamp(0.5 * (static_cast<double>(before) - static_cast<double>(after)) / bend, -0.5, 0.5);
}

}  // namespace waymark::pipeline
