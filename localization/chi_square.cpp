// SPDX-License-Identifier: Apache-2.0
#include "localization/chi_square.hpp"

#include <cassert>
#include <cmath>

namespace waymark::localization {

double chi_square_probability(double x, double freedom) {
  if (!(x > 0)) return 0;
  if (freedom > 1e6) {  // the series takes too long; Wilson & Hilferty (1931) is accurate to 1e-6 there
    const double s = 2 / (9 * freedom);
    return std::erfc((1 - s - std::cbrt(x / freedom)) / std::sqrt(2 * s)) / 2;
  }
  const double a = freedom / 2, half = x / 2;
  if (half > a + 40 * std::sqrt(a) + 60) return 1;
  double term = 1 / a, sum = term;
  for (double n = a + 1; term > 1e-17 * sum; ++n) sum += term *= half / n;
  return std::fmin(1, sum * std::exp(a * std::log(half) - half - std::lgamma(a)));
}

double chi_square_quantile(double p, double freedom) {
  assert(p > 0 && p < 1 && freedom >= 1);
  double low = 0, high = freedom;
  while (chi_square_probability(high, freedom) < p && high < 1e300) high *= 2;
  for (int i = 0; i < 80; ++i) {
    const double middle = (low + high) / 2;
    (chi_square_probability(middle, freedom) < p ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace waymark::localization
