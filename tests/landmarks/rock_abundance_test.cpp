// SPDX-License-Identifier: Apache-2.0
#include "landmarks/rock_abundance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace waymark::test {
namespace {

TEST(RockAbundance, NumbersAddUpToTheirArea) {
  // The area between two diameters is the difference of k exp(-q D); with thin bins N pi D^2 / 4 is the same.
  const double k = 0.1, q = 1.79 + 0.152 / k;
  double area = 0;
  for (double d = 0.2; d < 1.2 - 1e-9; d += 0.001)
    area += rocks_per_square_metre(k, d, d + 0.001) * std::numbers::pi / 4 * std::pow(d + 0.0005, 2);
  EXPECT_NEAR(area, k * (std::exp(-q * 0.2) - std::exp(-q * 1.2)), 1e-5);
}

TEST(RockAbundance, FitReturnsTheCoverOfACount) {
  for (const double k : {0.01, 0.07, 0.3}) {
    const double area = 1e6;
    const auto count = std::llround(rocks_per_square_metre(k, 0.3) * area);
    const RockCover fit = fit_rock_cover(count, 0.3, area);
    EXPECT_NEAR(fit.k, k, 0.02 * k);
    EXPECT_GT(fit.sd, 0);
    EXPECT_LT(fit.sd, 0.5 * k);
  }
}

TEST(RockAbundance, CompletenessIsTheFullestBin) {
  std::vector<double> diameters;
  for (int i = 0; i < 50; ++i) diameters.push_back(1.01);  // the bin from 1
  for (int i = 0; i < 20; ++i) diameters.push_back(0.6), diameters.push_back(2.1);
  EXPECT_DOUBLE_EQ(completeness_diameter(diameters), 1);
  EXPECT_TRUE(std::isnan(completeness_diameter(std::span(diameters).first(19))));
}

}  // namespace
}  // namespace waymark::test
