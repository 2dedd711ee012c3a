// SPDX-License-Identifier: Apache-2.0
#include "core/ziggurat.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace waymark {
namespace {

// Against the distribution function itself; the bound is that of Kolmogorov and Smirnov, missed once in 1000
// seeds.
TEST(Ziggurat, IsNormal) {
  constexpr std::size_t kDraws = 1000000;
  Random random(1, "ziggurat");
  const Ziggurat& normal = Ziggurat::shared();
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

// Beyond the lowest layer it is drawn in another way: 577 of a million are expected there, 27 beyond 4.2
// standard deviations, half of them on each side; within four standard errors.
TEST(Ziggurat, HasItsTails) {
  Random random(2, "ziggurat");
  const Ziggurat& normal = Ziggurat::shared();
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
}  // namespace waymark
