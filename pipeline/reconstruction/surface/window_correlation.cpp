// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/window_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace waymark::pipeline {
namespace {

constexpr int kSide = 2 * kWindowMargin + 1;
constexpr float kNoScore = std::numeric_limits<float>::quiet_NaN();

// Sums over windows; direct sums, so that a NaN spoils its own windows only and no order depends on position.
Eigen::ArrayXXf window_sums(const Eigen::ArrayXXf& values) {
  const Eigen::Index columns = values.rows() - 2 * kWindowMargin, rows = values.cols() - 2 * kWindowMargin;
  Eigen::ArrayXXf across = values.topRows(columns);
  for (int i = 1; i < kSide; ++i) across += values.middleRows(i, columns);
  Eigen::ArrayXXf sums = across.leftCols(rows);
  for (int j = 1; j < kSide; ++j) sums += across.middleCols(j, rows);
  return sums;
}

// Mean of the values that are not NaN: its subtraction keeps squares small in single precision.
float level_of(const Resampled& view) {
  double sum = 0, count = 0;
  for (const float value : view.reshaped())
    if (!std::isnan(value)) sum += static_cast<double>(value), ++count;
  return count > 0 ? static_cast<float>(sum / count) : 0.0f;
}

}  // namespace

WindowScores correlate_windows(std::span<const Resampled> views, std::span<const double> min_sd,
                               std::span<const ViewPair> pairs) {
  constexpr auto kCount = static_cast<float>(kSide * kSide);
  std::vector<Eigen::ArrayXXf> level, sums, scale;
  WindowScores scores;
  for (std::size_t v = 0; v < views.size(); ++v) {
    level.emplace_back(views[v] - level_of(views[v]));
    sums.push_back(window_sums(level[v]));
    const auto min_variance = static_cast<float>(min_sd[v] * min_sd[v]) * kCount;
    // 1 / sqrt(sum of squares about the mean); NaN without texture.
    scale.emplace_back(window_sums(level[v].square()) - sums[v].square() / kCount);
    scale[v] = (scale[v] > std::max(min_variance, 1e-6f)).select(1.0f / scale[v].sqrt(), kNoScore);
  }
  scores.textured = scores.complete = Eigen::ArrayXXf::Zero(scale[0].rows(), scale[0].cols());
  for (std::size_t v = 0; v < views.size(); ++v) {
    scores.textured += 1 - scale[v].isNaN().cast<float>();
    scores.complete += 1 - sums[v].isNaN().cast<float>();
  }
  for (const ViewPair& pair : pairs) {
    const std::size_t a = pair.first, b = pair.second;
    scores.pairs.emplace_back((window_sums(level[a] * level[b]) - sums[a] * sums[b] / kCount) * scale[a] *
                              scale[b]);
  }
  return scores;
}

float mean_of_largest(std::span<float> values, double fraction) {
  const auto end = std::remove_if(values.begin(), values.end(), [](float v) { return std::isnan(v); });
  const std::ptrdiff_t count = end - values.begin();
  if (count == 0) return kNoScore;
  const auto used =
      std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(std::ceil(fraction * double(count) - 1e-9)));
  std::partial_sort(values.begin(), values.begin() + used, end, std::greater<>());
  float sum = 0;
  for (std::ptrdiff_t i = 0; i < used; ++i) sum += values[static_cast<std::size_t>(i)];
  return sum / static_cast<float>(used);
}

}  // namespace waymark::pipeline
