// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/real_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark::pipeline {
namespace {

constexpr std::int64_t kEnough = 30;  // detections; fewer allow no statement
constexpr double kMinFraction = 0.02;

}  // namespace

double real_fraction(std::int64_t with, std::int64_t count, const PropertyLimits& limits) {
  if (count < kEnough) return 1;
  const auto n = static_cast<double>(count);
  const double upper = static_cast<double>(with) / n + 1 / std::sqrt(n);  // two standard deviations
  return std::clamp((upper - limits.alien) / (limits.usual - limits.alien), kMinFraction, 1.0);
}

void lower_to_fraction(std::span<double> probabilities, double fraction) {
  if (!(fraction < 1) || probabilities.empty()) return;
  std::vector<double> log_odds;
  double target = 0;
  for (const double probability : probabilities) {
    const double p = std::clamp(probability, 1e-9, 1 - 1e-9);
    log_odds.push_back(std::log(p / (1 - p)));
    target += fraction * p;
  }
  double low = -25, high = 0;  // of the shift
  for (int round = 0; round < 40; ++round) {
    const double shift = 0.5 * (low + high);
    double sum = 0;
    for (const double l : log_odds) sum += 1 / (1 + std::exp(-(l + shift)));
    (sum > target ? high : low) = shift;
  }
  for (std::size_t i = 0; i < log_odds.size(); ++i)
    probabilities[i] = 1 / (1 + std::exp(-(log_odds[i] + high)));
}

}  // namespace waymark::pipeline
