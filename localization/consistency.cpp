// SPDX-License-Identifier: Apache-2.0
#include "localization/consistency.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "localization/chi_square.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kMost = 4096;  // autocorrelations cost up to the square of it

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// Resamples to equally spaced times, holding values: autocorrelations are by lag in time, not in rows.
std::vector<double> evenly(std::span<const double> t, std::span<const double> values) {
  const std::size_t count = std::min(values.size(), kMost);
  const double step = (t.back() - t.front()) / static_cast<double>(std::max<std::size_t>(count, 2) - 1);
  std::vector<double> even;
  std::size_t row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (row + 1 < t.size() && t[row + 1] <= t.front() + step * static_cast<double>(i)) ++row;
    even.push_back(values[row]);
  }
  return even;
}

double effective_number(std::vector<double> x) {
  const double middle = mean(x);
  for (double& v : x) v -= middle;
  const auto product = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
    return sum;
  };
  const double variance = product(0);
  if (!(variance > 0)) return 1;
  double sum = 0, before = 2;
  for (std::size_t lag = 0; lag + 1 < x.size(); lag += 2) {
    const double pair = std::min(before, (product(lag) + product(lag + 1)) / variance);
    if (!(pair > 0)) break;
    sum += before = pair;
  }
  const auto count = static_cast<double>(x.size());
  return std::clamp(count / std::max(2 * sum - 1, 1e-12), 1.0, count);
}

}  // namespace

Consistency consistency(std::span<const double> t, std::span<const double> squares, double dimensions) {
  assert(!squares.empty() && t.size() == squares.size() && dimensions > 0);
  Consistency c{.anees = mean(squares) / dimensions, .independent = effective_number(evenly(t, squares))};
  const double freedom = dimensions * c.independent;
  c.low = chi_square_quantile(0.025, freedom) / freedom;
  c.high = chi_square_quantile(0.975, freedom) / freedom;
  return c;
}

}  // namespace waymark::localization
