// SPDX-License-Identifier: Apache-2.0
#include "core/feature.hpp"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace waymark::inline core {
namespace {

double weighted_mean(std::span<const WeightedValue> seen, double total) {
  double sum = 0;
  for (const auto& s : seen) sum += s.weight * s.value;
  return sum / total;
}

// Axes at 1 deg and 179 deg are 2 deg apart. Angles times 2 pi / period are directions, whose mean is the
// direction of the sum of their unit vectors.
double weighted_angle(std::span<const WeightedValue> seen, double total, double period) {
  const double turns = 2 * std::numbers::pi / period;
  std::complex<double> sum = 0;
  for (const auto& s : seen) sum += s.weight * std::polar(1.0, turns * s.value);
  if (!(std::abs(sum) > 1e-12 * total)) return seen.front().value;
  return std::arg(sum) / turns;
}

}  // namespace

double period(Scale scale) {
  return scale == Scale::axis ? std::numbers::pi : scale == Scale::direction ? 2 * std::numbers::pi : 0;
}

double difference(double a, double b, Scale scale) {
  return is_angle(scale) ? std::remainder(a - b, period(scale)) : a - b;
}

FeatureValue merge(std::span<const WeightedValue> seen, Scale scale) {
  assert(!seen.empty());
  double total = 0, squares = 0;
  for (const auto& s : seen) {
    assert(s.weight > 0);
    total += s.weight;
    squares += s.weight * s.weight;
  }
  const double value =
      is_angle(scale) ? weighted_angle(seen, total, period(scale)) : weighted_mean(seen, total);

  double spread = 0;
  for (const auto& s : seen) {
    const double d = difference(s.value, value, scale);
    spread += s.weight * d * d;
  }
  const double freedom = total - squares / total;  // n - 1 when every weight is 1
  const bool has_spread = seen.size() > 1 && freedom > 0;
  return {value, has_spread ? spread / freedom : 0, static_cast<int>(seen.size())};
}

}  // namespace waymark::inline core
