// SPDX-License-Identifier: Apache-2.0
#include "planning/relief_hazard.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planning/gaussian_table.hpp"

namespace waymark::planning {
namespace {

struct DiscCell {
  double x, y;  // cells from the middle
};

// At most about 1500 cells: beyond, every second, third ... row and column stands for its neighbours.
std::vector<DiscCell> disc_cells(const BaseFootprint& base) {
  const auto thin = static_cast<std::int64_t>(std::ceil(std::sqrt(double(base.cells()) / 1500)));
  std::vector<DiscCell> cells;
  const auto last = static_cast<std::int64_t>(base.half_widths.size()) - 1;
  for (std::int64_t dy = -(last / thin) * thin; dy <= last; dy += thin) {
    const std::int64_t w = base.half_widths[static_cast<std::size_t>(std::abs(dy))];
    for (std::int64_t dx = -(w / thin) * thin; dx <= w; dx += thin) cells.push_back({double(dx), double(dy)});
  }
  return cells;
}

double correlation_at(double distance, const HeightErrors& errors) {
  if (distance == 0) return 1;
  return errors.correlation > 0 ? std::exp(-std::pow(distance / errors.correlation, 2)) : 0;
}

}  // namespace

FitErrors propagate_errors(const BaseFootprint& base, const HeightErrors& errors) {
  FitErrors fit{.spread_x = base.xx() * base.cell_x * base.cell_x,
                .spread_y = base.yy() * base.cell_y * base.cell_y};
  // Relief within a cell is that of the base, scaled by their sizes with a Hurst exponent of 1/2.
  fit.unresolved =
      std::max(base.cell_x, base.cell_y) / (static_cast<double>(base.half_widths[0]) * base.cell_x);
  if (!(errors.sd > 0)) return fit;
  const std::vector<DiscCell> cells = disc_cells(base);
  const auto n = double(cells.size());
  // Variances of the mean and of both gradients under the correlation of the errors.
  double mean = 0, x = 0, y = 0, xx = 0, yy = 0;
  for (const DiscCell& a : cells) {
    xx += a.x * a.x, yy += a.y * a.y;
    for (const DiscCell& b : cells) {
      const double r =
          correlation_at(std::hypot((a.x - b.x) * base.cell_x, (a.y - b.y) * base.cell_y), errors);
      mean += r, x += r * a.x * b.x, y += r * a.y * b.y;
    }
  }
  const double thinned = double(base.cells()) / n;  // white errors average over the cells left out, too
  const double variance = errors.sd * errors.sd, white = errors.correlation > 0 ? 1 : 1 / thinned;
  const double from_mean = variance * mean / (n * n), var_x = variance * x / (xx * xx),
               var_y = variance * y / (yy * yy);
  fit.variance_x = white * var_x / (base.cell_x * base.cell_x);
  fit.variance_y = white * var_y / (base.cell_y * base.cell_y);
  fit.mean_square = std::max(0.0, variance - from_mean - var_x * xx / n - var_y * yy / n);
  const double patch = std::numbers::pi * errors.correlation * errors.correlation;
  const double per_cell = std::min(1.0, base.cell_x * base.cell_y / std::max(patch, 1e-30));
  fit.freedom = std::max(1.0, double(base.cells()) * per_cell - 3);
  fit.mean_square_sd = std::sqrt(2 / fit.freedom) * fit.mean_square;
  const double lag = std::max(double(base.lag_x) * base.cell_x, double(base.lag_y) * base.cell_y);
  fit.step_sd = errors.sd * std::sqrt(2 * (1 - correlation_at(lag, errors)));
  const double pairs = std::max(2.0, 4 * double(base.cells()) * per_cell);
  fit.step_bias = fit.step_sd * std::sqrt(2 * std::log(pairs));
  return fit;
}

double probability_above(const Uncertain& value, double limit) {
  if (!(value.sd > 0)) return value.value > limit ? 1 : 0;
  const double z = (value.value - limit) / value.sd;
  if (std::isnan(z)) return z;
  if (z >= kGaussianEnd) return 1;
  if (z <= -kGaussianEnd) return 0;
  const auto& table = gaussian_table();
  const double at = (z + kGaussianEnd) * kGaussianSteps;
  const auto i = static_cast<std::size_t>(at);
  return table[i] + (at - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

ReliefHazard assess_relief(const BaseRelief& relief, const FitErrors& errors, const Vehicle& vehicle) {
  constexpr double degree = std::numbers::pi / 180;
  ReliefHazard hazard;
  const double gx = relief.gradient_x, gy = relief.gradient_y, square = gx * gx + gy * gy;
  const double ms = double(relief.roughness) * double(relief.roughness);
  // The vehicle's supports rest on single heights of a rough base: its slope is not that of the plane.
  const double vx = std::max(errors.variance_x, ms / errors.spread_x);
  const double vy = std::max(errors.variance_y, ms / errors.spread_y);
  const double variance = square > 1e-12 ? (gx * gx * vx + gy * gy * vy) / square : std::max(vx, vy);
  hazard.slope = {std::atan(std::sqrt(square)) / degree, std::sqrt(variance) / (1 + square) / degree};
  const double true_ms = std::max(0.0, ms - errors.mean_square);
  const double sd_ms = errors.mean_square_sd + 2 * std::sqrt(true_ms * errors.mean_square / errors.freedom);
  const double roughness = std::sqrt(true_ms);
  hazard.roughness = {roughness, std::sqrt(true_ms + sd_ms) - roughness};
  const double raw = relief.step;
  const double unresolved = true_ms * errors.unresolved;
  hazard.step = {std::sqrt(std::max(0.0, raw * raw - errors.step_bias * errors.step_bias)),
                 std::sqrt(errors.step_sd * errors.step_sd + unresolved)};
  if (std::isnan(raw)) {  // std::max drops NaN
    hazard.roughness = hazard.step = {std::nan(""), std::nan("")};
    hazard.probability = std::nan("");
    return hazard;
  }
  const double safe = (1 - probability_above(hazard.slope, vehicle.max_slope.value)) *
                      (1 - probability_above(hazard.roughness, vehicle.max_roughness.value)) *
                      (1 - probability_above(hazard.step, vehicle.max_step.value));
  hazard.probability = 1 - safe;
  return hazard;
}

}  // namespace waymark::planning
