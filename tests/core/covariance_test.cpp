// SPDX-License-Identifier: Apache-2.0
#include "core/covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace waymark::test {
namespace {

Eigen::Matrix2d symmetric(double xx, double yy, double xy) {
  return (Eigen::Matrix2d() << xx, xy, xy, yy).finished();
}

TEST(Covariance, VariancesAndCorrelationDecide) {
  EXPECT_TRUE(is_covariance(symmetric(1, 4, 1.9)));
  EXPECT_TRUE(is_covariance(symmetric(1, 4, -2))) << "fully correlated";
  EXPECT_TRUE(is_covariance(symmetric(0, 0, 0))) << "exactly known";
  EXPECT_FALSE(is_covariance(symmetric(1, 4, 2.1)));
  EXPECT_FALSE(is_covariance(symmetric(-1, -4, 0))) << "its determinant is positive";
  EXPECT_FALSE(is_covariance(symmetric(0, 1, 1e-3)));
}

TEST(Covariance, RoundingOfAFullCorrelationIsAllowed) {
  for (const double angle : {0.1, 0.7, 1.3, 2.9})
    for (const double variance : {1e-6, 1.0, 1e8}) {
      const double c = std::cos(angle), s = std::sin(angle);
      EXPECT_TRUE(is_covariance(symmetric(variance * c * c, variance * s * s, variance * c * s))) << angle;
    }
}

TEST(Covariance, UnknownNumbersAreNone) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(is_covariance(symmetric(bad, 1, 0)));
    EXPECT_FALSE(is_covariance(symmetric(1, 1, bad)));
  }
}

}  // namespace
}  // namespace waymark::test
