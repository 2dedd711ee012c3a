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

// Axes at 1 deg and 179 deg are 2 deg apart. Doubling the angles maps axes to directions, whose mean is the
// direction of the sum of their unit vectors.
double weighted_axis(std::span<const WeightedValue> seen, double total) {
  std::complex<double> sum = 0;
  for (const auto& s : seen) sum += s.weight * std::polar(1.0, 2 * s.value);
  if (!(std::abs(sum) > 1e-12 * total)) return seen.front().value;
  return std::arg(sum) / 2;
}

}  // namespace

double difference(double a, double b, Scale scale) {
  return scale == Scale::axis ? std::remainder(a - b, std::numbers::pi) : a - b;
}

FeatureValue merge(std::span<const WeightedValue> seen, Scale scale) {
  assert(!seen.empty());
  double total = 0, squares = 0;
  for (const auto& s : seen) {
    assert(s.weight > 0);
    total += s.weight;
    squares += s.weight * s.weight;
  }
  const double value = scale == Scale::axis ? weighted_axis(seen, total) : weighted_mean(seen, total);

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
