// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/real_fraction.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr PropertyLimits kHalf{.alien = 0.5, .usual = 0.7};

TEST(RealFraction, IsOneForFewOrUsualOnes) {
  EXPECT_EQ(real_fraction(0, 29, kHalf), 1);
  EXPECT_EQ(real_fraction(7000, 10000, kHalf), 1);
  EXPECT_EQ(real_fraction(69, 100, kHalf), 1);  // within two standard deviations, 0.1
}

TEST(RealFraction, GrowsFromAlienToUsual) {
  EXPECT_EQ(real_fraction(0, 30, kHalf), 0.02);
  EXPECT_NEAR(real_fraction(5900, 10000, kHalf), 0.5, 1e-12);  // upper estimate 0.6
}

TEST(LowerToFraction, LeavesTheSumAskedFor) {
  std::vector<double> some{0.9, 0.99, 0.6, 0.1}, same = some;
  const double before = std::accumulate(some.begin(), some.end(), 0.0);
  lower_to_fraction(some, 0.3);
  EXPECT_NEAR(std::accumulate(some.begin(), some.end(), 0.0), 0.3 * before, 1e-6);
  EXPECT_GT(some[1], some[0]);  // the order stays
  lower_to_fraction(same, 1);
  EXPECT_EQ(same[0], 0.9);
  std::vector<double> none;
  lower_to_fraction(none, 0.1);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace waymark::test
