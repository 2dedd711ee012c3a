// SPDX-License-Identifier: Apache-2.0
#include "landmarks/rock_abundance.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace waymark::inline landmarks {
namespace {

constexpr double kMinCover = 1e-4, kMaxCover = 0.6;
constexpr std::size_t kMinRocks = 20;

}  // namespace

double rocks_per_square_metre(double k, double min_diameter, double max_diameter) {
  const double q = 1.79 + 0.152 / k;
  const double end = std::min(max_diameter, min_diameter + 40 / q);  // exp(-40) is nothing
  if (!(end > min_diameter)) return 0;
  // Simpson's rule in log D, in which the density of D^-2 exp(-q D) is smooth.
  constexpr int steps = 200;
  const double width = std::log(end / min_diameter) / steps;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double d = min_diameter * std::exp(width * i);
    const double density = 4 * k * q / std::numbers::pi * std::exp(-q * d) / d;  // per log D
    sum += density * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
  }
  return sum * width / 3;
}

RockCover fit_rock_cover(std::int64_t count, double diameter, double area) {
  const auto k_of = [&](double rocks) {
    double low = std::log(kMinCover), high = std::log(kMaxCover);
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (rocks_per_square_metre(std::exp(middle), diameter) * area < rocks ? low : high) = middle;
    }
    return std::exp((low + high) / 2);
  };
  const auto n = static_cast<double>(count);
  if (count <= 0) return {0, k_of(1)};
  return {k_of(n), (k_of(n + std::sqrt(n)) - k_of(n - std::sqrt(n))) / 2};
}

double completeness_diameter(std::span<const double> diameters) {
  if (diameters.size() < kMinRocks) return std::nan("");
  std::map<int, int> bins;
  for (const double d : diameters)
    if (d > 0) ++bins[static_cast<int>(std::floor(4 * std::log2(d)))];
  const auto fullest =
      std::ranges::max_element(bins, {}, [](const auto& bin) { return std::pair(bin.second, bin.first); });
  return fullest == bins.end() ? std::nan("") : std::exp2(fullest->first / 4.0);
}

}  // namespace waymark::inline landmarks
