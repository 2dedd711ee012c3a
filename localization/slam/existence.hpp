// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
namespace waymark {

/// Evidence counters (section 4.4; Thrun, Burgard & Fox 2005, 10.3.4): that a landmark exists, as log odds.
inline constexpr double kSurestLogOdds = 8;  ///< more says nothing more, and would take for ever to unlearn

inline double log_odds(double probability) {
  const double p = std::clamp(probability, 1e-6, 1 - 1e-6);
  return std::clamp(std::log(p / (1 - p)), -kSurestLogOdds, kSurestLogOdds);
}

inline double probability_of(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

/// What not being seen says of a landmark that should have been: at most `most` (log odds, < 0), and less for
/// a sensor that often misses what is there. `detection`: part of the landmarks expected that is seen, (0,
/// 1).
inline double unseen_evidence(double detection, double most) {
  return std::max(most, std::log(1 - std::clamp(detection, 0.01, 0.99)));
}

}  // namespace waymark
