// SPDX-License-Identifier: Apache-2.0
#include "planning/landing_safety.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.hpp"

namespace waymark::planning {
namespace {

constexpr double kBlurReach = 4;           // standard deviations
constexpr double kMinConditional = 3;      // cells: narrower blurs along rows are summed directly
constexpr double kInterpolation = 1. / 6;  // cells^2, mean variance that linear interpolation adds

double value_at(const Grid<float>& safe, std::int64_t column, std::int64_t row) {
  const double value = safe(column, row);
  return value >= 0 ? value : 0;  // NaN: unknown
}

std::int64_t reach_of_sd(double variance) {
  return static_cast<std::int64_t>(std::ceil(kBlurReach * std::sqrt(variance)));
}

std::vector<double> gaussian(std::int64_t half, double variance) {
  std::vector<double> weights;
  double sum = 0;
  for (std::int64_t i = -half; i <= half; ++i) {
    weights.push_back(std::exp(-0.5 * static_cast<double>(i * i) / variance));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace

Eigen::Matrix2d covariance_in_cells(const LandingError& error, double cell_x, double cell_y) {
  const double a = error.azimuth * kRadiansPerDegree;
  const Eigen::Vector2d along(std::sin(a) / cell_x, -std::cos(a) / cell_y);
  const Eigen::Vector2d across(std::cos(a) / cell_x, std::sin(a) / cell_y);
  return error.major * error.major * along * along.transpose() +
         error.minor * error.minor * across * across.transpose();
}

LandingMargin landing_margin(const Eigen::Matrix2d& covariance) {
  return {reach_of_sd(covariance(0, 0)) + 1, reach_of_sd(covariance(1, 1)) + 1};
}

Grid<float> landing_safety_directly(const Grid<float>& safe, const Window& inner,
                                    const Eigen::Matrix2d& covariance) {
  const LandingMargin margin = landing_margin(covariance);
  const Eigen::Matrix2d information = covariance.inverse();
  struct Tap {
    std::int64_t dx, dy;
    double weight;
  };
  std::vector<Tap> taps;
  double sum = 0;
  for (std::int64_t dy = -margin.rows; dy <= margin.rows; ++dy)
    for (std::int64_t dx = -margin.columns; dx <= margin.columns; ++dx) {
      const Eigen::Vector2d d(static_cast<double>(dx), static_cast<double>(dy));
      const double squares = d.dot(information * d);
      if (squares > kBlurReach * kBlurReach) continue;
      taps.push_back({dx, dy, std::exp(-0.5 * squares)});
      sum += taps.back().weight;
    }
  Grid<float> out(inner.columns, inner.rows);
  for (std::int64_t r = 0; r < inner.rows; ++r)
    for (std::int64_t c = 0; c < inner.columns; ++c) {
      double value = 0;
      for (const Tap& tap : taps)
        value += tap.weight * value_at(safe, inner.column + c + tap.dx, inner.row + r + tap.dy);
      out(c, r) = static_cast<float>(value / sum);
    }
  return out;
}

Grid<float> landing_safety(const Grid<float>& safe, const Window& inner, const Eigen::Matrix2d& covariance) {
  // Of the offset (x, y): y ~ N(0, c), and x given y ~ N(slant y, a - b^2 / c).
  const double c = covariance(1, 1), slant = covariance(0, 1) / c;
  const double conditional = covariance(0, 0) - covariance(0, 1) * slant;
  if (!(conditional >= kMinConditional * kMinConditional))
    return landing_safety_directly(safe, inner, covariance);
  const LandingMargin margin = landing_margin(covariance);
  const std::int64_t half_rows = reach_of_sd(c), half = reach_of_sd(conditional);
  const std::vector<double> along = gaussian(half, conditional - kInterpolation),
                            down = gaussian(half_rows, c);
  // Rows are blurred where their slanted columns fall: those of `inner`, moved by up to the slant's reach.
  const auto shift =
      std::min(margin.columns,
               static_cast<std::int64_t>(std::ceil(std::abs(slant) * static_cast<double>(half_rows))) + 1);
  const std::int64_t columns = inner.columns + 2 * shift, rows = inner.rows + 2 * half_rows;
  Grid<double> blurred(columns, rows);
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t i = 0; i < columns; ++i) {
      double value = 0;
      for (std::int64_t k = -half; k <= half; ++k) {
        const std::int64_t column = inner.column - shift + i + k;
        if (column < 0 || column >= safe.columns()) continue;  // beyond four standard deviations
        value +=
            along[static_cast<std::size_t>(k + half)] * value_at(safe, column, inner.row - half_rows + r);
      }
      blurred(i, r) = value;
    }
  Grid<float> out(inner.columns, inner.rows);
  for (std::int64_t r = 0; r < inner.rows; ++r)
    for (std::int64_t i = 0; i < inner.columns; ++i) {
      double value = 0;
      for (std::int64_t k = -half_rows; k <= half_rows; ++k) {
        const double x = static_cast<double>(i + shift) + slant * static_cast<double>(k);
        const auto left = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(x)), 0, columns - 2);
        const double part = std::clamp(x - static_cast<double>(left), 0.0, 1.0);
        const std::int64_t row = r + half_rows + k;
        value += down[static_cast<std::size_t>(k + half_rows)] *
                 ((1 - part) * blurred(left, row) + part * blurred(left + 1, row));
      }
      out(i, r) = static_cast<float>(value);
    }
  return out;
}

}  // namespace waymark::planning
