// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/class_prior.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {

double prior_shift(std::span<const double> log_odds, double training_prior) {
  constexpr double kPseudoCount = 4;
  const auto odds = [](double prior) { return std::log(prior / (1 - prior)); };
  double prior = training_prior;
  for (int round = 0; round < 100; ++round) {
    const double shift = odds(prior) - odds(training_prior), before = prior;
    double expected = kPseudoCount * training_prior;
    for (const double l : log_odds) expected += 1 / (1 + std::exp(-(l + shift)));
    prior = std::clamp(expected / (double(log_odds.size()) + kPseudoCount), 0.02, 0.98);
    if (std::abs(prior - before) < 1e-9) break;
  }
  return odds(prior) - odds(training_prior);
}

}  // namespace waymark::pipeline
