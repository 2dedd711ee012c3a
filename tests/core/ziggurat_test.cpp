// SPDX-License-Identifier: Apache-2.0
#include "core/ziggurat.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace waymark::test {
namespace {

// Compares with the normal distribution function. The bound is that of Kolmogorov and Smirnov, exceeded by
// one of 1000 seeds.
TEST(Ziggurat, IsNormal) {
  constexpr std::size_t kDraws = 1000000;
  Random random(1, "ziggurat");
  const Ziggurat& normal = Ziggurat::instance();
  std::vector<double> drawn(kDraws);
  for (double& x : drawn) x = normal(random);
  std::ranges::sort(drawn);
  double farthest = 0;
  for (std::size_t i = 0; i < kDraws; ++i) {
    const double part = static_cast<double>(i) / kDraws;
    farthest = std::max(farthest, std::abs(std::erfc(-drawn[i] / std::sqrt(2)) / 2 - part));
  }
  EXPECT_LT(farthest, 1.95 / std::sqrt(kDraws));
}

// The tail beyond the lowest layer is sampled separately. Expects 577 of a million there and 27 beyond 4.2
// standard deviations, half on each side, within four standard errors.
TEST(Ziggurat, HasItsTails) {
  Random random(2, "ziggurat");
  const Ziggurat& normal = Ziggurat::instance();
  int right = 0, left = 0, far = 0;
  for (int i = 0; i < 4000000; ++i) {
    const double x = normal(random);
    right += x > 3.442619855899;
    left += x < -3.442619855899;
    far += std::abs(x) > 4.2;
  }
  EXPECT_NEAR(right, 4 * 288.5, 4 * 34);
  EXPECT_NEAR(left, 4 * 288.5, 4 * 34);
  EXPECT_NEAR(far, 4 * 26.7, 4 * 10.4);
}

}  // namespace
}  // namespace waymark::test
