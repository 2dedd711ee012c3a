// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/existence.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {

double existence_probability(std::span<const double> confidences, int missed, const ExistenceRules& rules) {
  if (confidences.empty()) return 0;
  double best = -1e30, sum = 0;
  for (const double c : confidences) {
    const double bounded = std::clamp(c, 1e-3, 1 - 1e-3);
    const double odds = std::log(bounded / (1 - bounded));
    best = std::max(best, odds);
    sum += odds;
  }
  const double logit = best + rules.further_detection * (sum - best) -
                       rules.missed_image * std::max(missed, 0) - rules.prior_penalty;
  return 1 / (1 + std::exp(-logit));
}

}  // namespace waymark::pipeline
