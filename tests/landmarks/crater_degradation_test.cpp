// SPDX-License-Identifier: Apache-2.0
#include "landmarks/crater_degradation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark::test {
namespace {

// The slow twin: diffusion over a time t filters the surface with a Gaussian of variance 2 t.
double filtered_height(double r, double time) {
  constexpr double kCell = 0.025;
  const double width = 5 * std::sqrt(2 * time);
  double sum = 0, total = 0;
  for (double x = r - width; x <= r + width; x += kCell)
    for (double y = -width; y <= width; y += kCell) {
      const double weight = std::exp(-((x - r) * (x - r) + y * y) / (4 * time));
      sum += weight * fresh_crater_height(std::hypot(x, y));
      total += weight;
    }
  return sum / total;
}

TEST(CraterDegradation, FreshBowlHasItsPublishedDepthAndRim) {
  EXPECT_NEAR(fresh_crater_height(1) - fresh_crater_height(0), 0.2, 1e-12);
  EXPECT_NEAR(fresh_crater_height(1), 0.036, 1e-12);
  EXPECT_NEAR(fresh_crater_height(2), 0.036 / 8, 1e-12);
}

TEST(CraterDegradation, IsAGaussianFilter) {
  DiffusingCrater crater(8);
  for (const double time : {0.01, 0.05, 0.2, 0.6}) {
    crater.advance_to(time);
    for (const double r : {0.0, 0.4, 0.9, 1.0, 1.3, 2.0, 4.0}) {
      const auto i = static_cast<std::size_t>(std::lround(r / DiffusingCrater::kSpacing));
      EXPECT_NEAR(crater.heights()[i], filtered_height(r, crater.time()), 1e-4) << time << " " << r;
    }
  }
}

}  // namespace
}  // namespace waymark::test
