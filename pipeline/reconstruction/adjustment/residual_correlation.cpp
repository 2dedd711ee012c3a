// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/residual_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace waymark::pipeline {
namespace {

constexpr double kUncorrelated = 0.05;
constexpr std::int64_t kMinPairs = 30;  // of cells; fewer show no correlation

}  // namespace

double ResidualCorrelation::at(double lag) const {
  const auto low = static_cast<std::size_t>(lag);
  if (low >= by_lag.size()) return 0;
  const double next = low + 1 < by_lag.size() ? by_lag[low + 1] : 0;
  return by_lag[low] + (lag - double(low)) * (next - by_lag[low]);
}

double ResidualCorrelation::shared_cells(const Grid<float>& residuals) const {
  const auto reach = static_cast<std::int64_t>(by_lag.size());
  double sum = 0;
  std::int64_t known = 0;
  for (std::int64_t r = 0; r < residuals.rows(); ++r)
    for (std::int64_t c = 0; c < residuals.columns(); ++c) {
      if (std::isnan(residuals(c, r))) continue;
      ++known;
      for (std::int64_t y = -reach; y <= reach; ++y)
        for (std::int64_t x = -reach; x <= reach; ++x)
          if (residuals.contains(c + x, r + y) && !std::isnan(residuals(c + x, r + y)))
            sum += at(std::hypot(double(x), double(y)));
    }
  return known > 0 ? sum / double(known) : 1;
}

ResidualCorrelation correlation_of(const Grid<float>& residuals, double limit) {
  const std::int64_t columns = residuals.columns(), rows = residuals.rows();
  ResidualCorrelation out;
  for (std::int64_t lag = 1; lag < std::max(columns, rows) / 3; ++lag) {
    double products = 0, squares = 0;
    std::int64_t pairs = 0;
    for (std::int64_t r = 0; r < rows; ++r)
      for (std::int64_t c = 0; c < columns; ++c) {
        const double a = residuals(c, r);
        if (!(std::abs(a) < limit)) continue;
        for (const auto& [x, y] : {std::pair(c + lag, r), std::pair(c, r + lag)}) {
          if (x >= columns || y >= rows) continue;
          const double b = residuals(x, y);
          if (!(std::abs(b) < limit)) continue;
          products += a * b;
          squares += (a * a + b * b) / 2;
          ++pairs;
        }
      }
    if (pairs < kMinPairs || !(products > kUncorrelated * squares)) break;
    out.by_lag.push_back(products / squares);
  }
  return out;
}

}  // namespace waymark::pipeline
