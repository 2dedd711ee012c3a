// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {

double expected_visibility(Meters prominence, Meters isolation, Meters body_radius, Meters range) {
  const double apart = std::min(isolation.value, range.value);
  if (!(prominence.value > 0) || !(apart > 0) || !(range.value > 0)) return 0;
  const double horizon = std::min(range.value, std::sqrt(2 * body_radius.value * prominence.value));
  const double free_length = std::sqrt(kSightLength * std::sqrt(prominence.value * apart));
  const double x = horizon / free_length;
  // 1 - (1 + x) exp(-x), without cancellation for small x
  const double fraction = x < 1e-4 ? x * x / 2 : 1 - (1 + x) * std::exp(-x);
  const double ratio = free_length / range.value;
  return std::clamp(2 * ratio * ratio * fraction, 0.0, 1.0);
}

}  // namespace waymark::pipeline
