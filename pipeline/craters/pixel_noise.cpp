// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/pixel_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace waymark::pipeline {
namespace {

// Four independent sums at once, for speed.
template <class Term>
double sum_of(const float* pixels, std::size_t count, const Term& term) {
  std::array<double, 4> parts{};
  std::size_t i = 0;
  for (; i + parts.size() <= count; i += parts.size())
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k] += term(double(pixels[i + k]));
  for (; i < count; ++i) parts[0] += term(double(pixels[i]));
  return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

}  // namespace

double pixel_noise(const float* pixels, int columns, int rows) {
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  if (count == 0) return 0;
  const double mean = sum_of(pixels, count, [](double v) { return v; }) / static_cast<double>(count);
  const double squares = sum_of(pixels, count, [&](double v) { return (v - mean) * (v - mean); });
  const double floor = 1e-3 * std::sqrt(squares / static_cast<double>(count));
  if (columns < 3 || rows < 3) return floor;

  std::vector<float> differences;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count) / 2e5)));
  for (int y = 1; y + 1 < rows; y += step)
    for (int x = 1; x + 1 < columns; x += step) {
      const float* p = pixels + static_cast<std::ptrdiff_t>(y) * columns + x;
      differences.push_back(std::abs(4 * p[0] - 2 * (p[-1] + p[1] + p[-columns] + p[columns]) +
                                     p[-columns - 1] + p[-columns + 1] + p[columns - 1] + p[columns + 1]));
    }
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return std::max(floor, *middle / 0.6745 / 6);  // 6: norm of the weights of the difference
}

}  // namespace waymark::pipeline
