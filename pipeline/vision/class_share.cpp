// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/class_share.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {

double share_shift(std::span<const double> log_odds, double fitted_share) {
  constexpr double kImagined = 4;
  const auto odds = [](double share) { return std::log(share / (1 - share)); };
  double share = fitted_share;
  for (int round = 0; round < 100; ++round) {
    const double shift = odds(share) - odds(fitted_share), before = share;
    double expected = kImagined * fitted_share;
    for (const double l : log_odds) expected += 1 / (1 + std::exp(-(l + shift)));
    share = std::clamp(expected / (double(log_odds.size()) + kImagined), 0.02, 0.98);
    if (std::abs(share - before) < 1e-9) break;
  }
  return odds(share) - odds(fitted_share);
}

}  // namespace waymark
