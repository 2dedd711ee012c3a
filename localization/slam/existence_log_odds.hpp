// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
namespace waymark::localization {

/// Evidence counters of a landmark's existence as log odds (section 4.4; Thrun, Burgard & Fox 2005,
/// 10.3.4).
inline constexpr double kSurestLogOdds = 8;  ///< limit; larger values would take too long to revise

inline double log_odds(double probability) {
  const double p = std::clamp(probability, 1e-6, 1 - 1e-6);
  return std::clamp(std::log(p / (1 - p)), -kSurestLogOdds, kSurestLogOdds);
}

inline double probability_from_log_odds(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

/// Returns the log odds that a missed detection adds to a landmark's existence: at least `most` (< 0), less
/// in magnitude for a sensor that often misses. `detection`: detection probability, (0, 1).
inline double unseen_evidence(double detection, double min_evidence) {
  return std::max(min_evidence, std::log(1 - std::clamp(detection, 0.01, 0.99)));
}

}  // namespace waymark::localization
