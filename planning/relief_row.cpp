// SPDX-License-Identifier: Apache-2.0
#include "planning/relief_row.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "planning/gaussian_table.hpp"

namespace waymark::planning {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// What the loops read and write.
struct RowPointers {
  std::size_t cells;
  const BaseRelief* relief;
  double *slope, *slope_sd, *probability;
  float *slope_band, *slope_sd_band, *roughness, *roughness_sd, *step, *step_sd;
};

struct Limits {
  double slope, roughness, step;
};

// The table of the Gaussian between an entry of 0 and two of 1, which take what lies beyond its ends.
constexpr double kBelow = -1, kBeyond = kGaussianEntries;

const double* table_with_ends() {
  static const std::vector<double> table = [] {
    std::vector<double> all{0};
    all.insert(all.end(), gaussian_table().begin(), gaussian_table().end());
    all.insert(all.end(), 2, 1.0);
    return all;
  }();
  return table.data() + 1;
}

/// Returns where the table has probability_above().
[[gnu::always_inline]] inline double table_position(double value, double sd, double limit) {
  const double certain = value > limit ? kGaussianEnd : -kGaussianEnd, scaled = (value - limit) / sd;
  const double z = sd > 0 ? scaled : certain;
  const double at = (z + kGaussianEnd) * kGaussianSteps;
  const double not_below = z > -kGaussianEnd ? at : kBelow;
  return z < kGaussianEnd ? not_below : kBeyond;
}

[[gnu::always_inline]] inline double table_value(const double* table, double at) {
  const int i = static_cast<int>(at);
  return table[i] + (at - i) * (table[i + 1] - table[i]);
}

/// The tangent of the slope, and the slope's sd.
[[gnu::always_inline]] inline void fill_slopes(const RowPointers& row, const FitErrors& errors) {
  const double variance_x = errors.variance_x, variance_y = errors.variance_y;
  const double spread_x = errors.spread_x, spread_y = errors.spread_y;
#pragma GCC ivdep  // the bands are apart
  for (std::size_t i = 0; i < row.cells; ++i) {
    const double gx = row.relief[i].gradient_x, gy = row.relief[i].gradient_y;
    const double roughness = row.relief[i].roughness;
    const double square = gx * gx + gy * gy, ms = roughness * roughness;
    const double from_x = ms / spread_x, from_y = ms / spread_y;
    const double vx = variance_x < from_x ? from_x : variance_x;
    const double vy = variance_y < from_y ? from_y : variance_y;
    const double along = (gx * gx * vx + gy * gy * vy) / square;
    const double larger = vx < vy ? vy : vx;
    const double variance = square > 1e-12 ? along : larger;
    row.slope[i] = std::sqrt(square);
    row.slope_sd[i] = std::sqrt(variance) / (1 + square) / kDegree;
  }
}

/// The bands, given the arc of the slope, radians; then the positions in the table of the Gaussian.
[[gnu::always_inline]] inline void fill_bands(const RowPointers& row, const FitErrors& errors,
                                              const Limits& limits) {
  const double mean_square = errors.mean_square, mean_square_sd = errors.mean_square_sd;
  const double freedom = errors.freedom, unresolved = errors.unresolved;
  const double bias_square = errors.step_bias * errors.step_bias,
               step_square = errors.step_sd * errors.step_sd;
#pragma GCC ivdep  // the bands are apart
  for (std::size_t i = 0; i < row.cells; ++i) {
    const double raw_roughness = row.relief[i].roughness, raw_step = row.relief[i].step;
    const double slope = row.slope[i] / kDegree, slope_sd = row.slope_sd[i];
    const double beyond = raw_roughness * raw_roughness - mean_square;
    const double true_ms = 0.0 < beyond ? beyond : 0.0;
    const double sd_ms = mean_square_sd + 2 * std::sqrt(true_ms * mean_square / freedom);
    const double roughness = std::sqrt(true_ms);
    const double roughness_sd = std::sqrt(true_ms + sd_ms) - roughness;
    const double step_beyond = raw_step * raw_step - bias_square;
    const double step = std::sqrt(0.0 < step_beyond ? step_beyond : 0.0);
    const double step_sd = std::sqrt(step_square + true_ms * unresolved);
    row.slope[i] = table_position(slope, slope_sd, limits.slope);
    row.slope_sd[i] = table_position(roughness, roughness_sd, limits.roughness);
    row.probability[i] = table_position(step, step_sd, limits.step);
    const bool is_known = raw_step == raw_step;
    row.slope_band[i] = is_known ? static_cast<float>(slope) : kUnknown;
    row.slope_sd_band[i] = is_known ? static_cast<float>(slope_sd) : kUnknown;
    row.roughness[i] = is_known ? static_cast<float>(roughness) : kUnknown;
    row.roughness_sd[i] = is_known ? static_cast<float>(roughness_sd) : kUnknown;
    row.step[i] = is_known ? static_cast<float>(step) : kUnknown;
    row.step_sd[i] = is_known ? static_cast<float>(step_sd) : kUnknown;
  }
}

void fill_slopes_plain(const RowPointers& row, const FitErrors& errors) {
  fill_slopes(row, errors);
}
void fill_bands_plain(const RowPointers& row, const FitErrors& errors, const Limits& limits) {
  fill_bands(row, errors, limits);
}

// The same bits with wider registers. With the target attribute alone, g++ 12 forgets the options of this
// file.
#ifdef __x86_64__
#define WAYMARK_AVX2 [[gnu::target("avx2"), gnu::optimize("O3", "no-math-errno", "no-trapping-math")]]
WAYMARK_AVX2 void fill_slopes_avx2(const RowPointers& row, const FitErrors& errors) {
  fill_slopes(row, errors);
}
WAYMARK_AVX2 void fill_bands_avx2(const RowPointers& row, const FitErrors& errors, const Limits& limits) {
  fill_bands(row, errors, limits);
}
#undef WAYMARK_AVX2
const bool kHasAvx2 = __builtin_cpu_supports("avx2");
#endif

}  // namespace

std::span<const double> ReliefRow::assess(std::span<const BaseRelief> relief, const Bands& bands) {
  const std::size_t cells = relief.size();
  slope_.resize(cells), slope_sd_.resize(cells), probability_.resize(cells);
  const RowPointers row{cells,
                        relief.data(),
                        slope_.data(),
                        slope_sd_.data(),
                        probability_.data(),
                        bands.slope.data(),
                        bands.slope_sd.data(),
                        bands.roughness.data(),
                        bands.roughness_sd.data(),
                        bands.step.data(),
                        bands.step_sd.data()};
  const Limits limits{vehicle_.max_slope.value, vehicle_.max_roughness.value, vehicle_.max_step.value};
#ifdef __x86_64__
  const auto slopes = kHasAvx2 ? fill_slopes_avx2 : fill_slopes_plain;
  const auto all = kHasAvx2 ? fill_bands_avx2 : fill_bands_plain;
#else
  const auto slopes = fill_slopes_plain;
  const auto all = fill_bands_plain;
#endif
  slopes(row, errors_);
  for (double& slope : slope_) slope = std::atan(slope);
  all(row, errors_, limits);
  const double* const table = table_with_ends();
  for (std::size_t i = 0; i < cells; ++i)
    probability_[i] = 1 - (1 - table_value(table, slope_[i])) * (1 - table_value(table, slope_sd_[i])) *
                              (1 - table_value(table, probability_[i]));
  return probability_;
}

}  // namespace waymark::planning
