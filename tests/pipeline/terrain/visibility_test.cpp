// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/visibility.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr Meters kEarth{6371000}, kRange{10000};

double number(int low, int high) {
  return 0.1 * *rc::gen::inRange(10 * low, 10 * high);
}

RC_GTEST_PROP(Visibility, NeverFallsWithProminenceIsolationOrTheBodysRadius, ()) {
  const Meters prominence{number(1, 5000)}, isolation{number(1, 500000)}, radius{number(1000000, 7000000)};
  const double fraction = expected_visibility(prominence, isolation, radius, kRange);
  const double more = 1 + number(0, 3);
  RC_ASSERT(fraction >= 0);
  RC_ASSERT(fraction <= 1);
  RC_ASSERT(expected_visibility(more * prominence, isolation, radius, kRange) >= fraction);
  RC_ASSERT(expected_visibility(prominence, more * isolation, radius, kRange) >= fraction);
  RC_ASSERT(expected_visibility(prominence, isolation, more * radius, kRange) >= fraction);
}

TEST(Visibility, IsTheAverageOfItsModelOverTheDisc) {
  const double prominence = 300, isolation = 4000;
  const double free_length = std::sqrt(kSightLength * std::sqrt(prominence * isolation));
  double sum = 0;
  const int rings = 200000;
  for (int i = 0; i < rings; ++i) {
    const double r = kRange.value * (i + 0.5) / rings;
    if (r * r < 2 * kEarth.value * prominence)
      sum += std::exp(-r / free_length) * 2 * r / kRange.value / rings;
  }
  EXPECT_NEAR(expected_visibility({prominence}, {isolation}, kEarth, kRange), sum, 1e-6);
}

TEST(Visibility, TheCurveOfASmallBodyHidesALowHill) {
  const double on_earth = expected_visibility({1}, {1e5}, kEarth, kRange);
  const double on_phobos = expected_visibility({1}, {1e5}, {11000}, kRange);
  EXPECT_LT(on_phobos, on_earth / 50);
  EXPECT_GT(on_phobos, 0);
}

TEST(Visibility, TheHighestSummitHasNoLimitOfIsolation) {
  EXPECT_EQ(expected_visibility({500}, {std::numeric_limits<double>::infinity()}, kEarth, kRange),
            expected_visibility({500}, kRange, kEarth, kRange));
}

TEST(Visibility, NothingIsSeenOfWhatDoesNotStandOut) {
  EXPECT_EQ(expected_visibility({0}, {1000}, kEarth, kRange), 0);
  EXPECT_EQ(expected_visibility({100}, {0}, kEarth, kRange), 0);
  EXPECT_EQ(expected_visibility({std::nan("")}, {1000}, kEarth, kRange), 0);
}

}  // namespace
}  // namespace waymark::test
