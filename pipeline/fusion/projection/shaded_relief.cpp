// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/shaded_relief.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::pipeline {
namespace {

constexpr double kGrazing = 0.03;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

void compute_shading(ShadedRelief& relief, const Sun& sun) {
  const Direction<GridFrame> light = sun_direction(sun);
  const Grid<float>& z = relief.height;
  Grid<float> dark(z.columns(), z.rows(), 0);
  relief.light = Grid<float>(z.columns(), z.rows(), kUnknown);
  tbb::parallel_for(std::int64_t{1}, std::max<std::int64_t>(z.rows() - 1, 1), [&](std::int64_t r) {
    for (std::int64_t c = 1; c + 1 < z.columns(); ++c) {
      const double p = double(z(c + 1, r) - z(c - 1, r)) / (2 * relief.step_x);
      const double q = double(z(c, r - 1) - z(c, r + 1)) / (2 * relief.step_y);
      const double cosine = Eigen::Vector3d(-p, -q, 1).normalized().dot(light.unit);
      if (std::isnan(cosine)) continue;
      relief.light(c, r) = static_cast<float>(cosine);
      dark(c, r) = cosine < kGrazing ? 1.0F : 0.0F;
    }
  });
  for (std::int64_t r = 1; r + 1 < z.rows(); ++r)
    for (std::int64_t c = 1; c + 1 < z.columns(); ++c)
      for (std::int64_t b = -1; b <= 1; ++b)
        for (std::int64_t a = -1; a <= 1; ++a)
          if (dark(c + a, r + b) > 0) relief.light(c, r) = kUnknown;
}

// Running sums over windows of 2 radius + 1 values.
template <class Get, class Put>
void running_sums(std::int64_t n, int radius, const Get& get, const Put& put) {
  double total = 0, known = 0;
  const auto add = [&](std::int64_t i, double sign) {
    if (i < 0 || i >= n) return;
    const auto [value, count] = get(i);
    total += sign * value, known += sign * count;
  };
  for (std::int64_t i = 0; i < radius; ++i) add(i, 1);
  for (std::int64_t i = 0; i < n; ++i) {
    add(i + radius, 1);
    put(i, total, known);
    add(i - radius, -1);
  }
}

}  // namespace

ShadedRelief shaded_relief(const Terrain& terrain, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                           int cells, const Sun& sun) {
  const Grid<float>& fine = terrain.heights();
  const auto within = [](double at, std::int64_t end) {
    return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(end)));
  };
  const std::int64_t left = within((low.x() - terrain.x0()) / terrain.step_x(), fine.columns()),
                     right = within((high.x() - terrain.x0()) / terrain.step_x() + 1, fine.columns()),
                     top = within((terrain.y0() - high.y()) / terrain.step_y(), fine.rows()),
                     bottom = within((terrain.y0() - low.y()) / terrain.step_y() + 1, fine.rows());
  ShadedRelief relief;
  const double middle = static_cast<double>(cells - 1) / 2;
  relief.step_x = cells * terrain.step_x(), relief.step_y = cells * terrain.step_y();
  relief.x0 = terrain.x0() + (static_cast<double>(left) + middle) * terrain.step_x();
  relief.y0 = terrain.y0() - (static_cast<double>(top) + middle) * terrain.step_y();
  relief.height = Grid<float>((right - left) / cells, (bottom - top) / cells, kUnknown);
  for (std::int64_t r = 0; r < relief.height.rows(); ++r)
    for (std::int64_t c = 0; c < relief.height.columns(); ++c) {
      double sum = 0;
      for (int b = 0; b < cells; ++b)
        for (int a = 0; a < cells; ++a) {
          const float z = fine(left + c * cells + a, top + r * cells + b);
          sum += z > -1e30F ? static_cast<double>(z) : std::nan("");
        }
      relief.height(c, r) = static_cast<float>(sum / (cells * cells));
    }
  compute_shading(relief, sun);
  return relief;
}

Grid<float> high_pass(const Grid<float>& values, int radius) {
  const std::int64_t columns = values.columns(), rows = values.rows();
  Grid<float> sums(columns, rows, 0), counts(columns, rows, 0), fine(columns, rows, kUnknown);
  for (std::int64_t r = 0; r < rows; ++r)
    running_sums(
        columns, radius,
        [&](std::int64_t c) {
          const float v = values(c, r);
          return std::isnan(v) ? std::pair(0.0, 0.0) : std::pair(static_cast<double>(v), 1.0);
        },
        [&](std::int64_t c, double total, double known) {
          sums(c, r) = static_cast<float>(total), counts(c, r) = static_cast<float>(known);
        });
  for (std::int64_t c = 0; c < columns; ++c)
    running_sums(
        rows, radius,
        [&](std::int64_t r) {
          return std::pair(static_cast<double>(sums(c, r)), static_cast<double>(counts(c, r)));
        },
        [&](std::int64_t r, double total, double known) {
          if (known > 0.5) fine(c, r) = values(c, r) - static_cast<float>(total / known);
        });
  return fine;
}

Pixels downsample(const Pixels& pixels, int factor) {
  if (factor <= 1) return pixels;
  Pixels small(pixels.columns() / factor, pixels.rows() / factor, 0);
  for (std::int64_t r = 0; r < small.rows(); ++r)
    for (std::int64_t c = 0; c < small.columns(); ++c) {
      double sum = 0;
      for (int b = 0; b < factor; ++b)
        for (int a = 0; a < factor; ++a) sum += static_cast<double>(pixels(c * factor + a, r * factor + b));
      small(c, r) = static_cast<float>(sum / (factor * factor));
    }
  return small;
}

}  // namespace waymark::pipeline
