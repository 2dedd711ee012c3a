// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/class_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.hpp"
#include "pipeline/vision/image_faults.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// Two normal distributions of log odds, calibrated for equal priors, drawn with another prior.
std::vector<double> drawn(double share, int count, std::uint64_t seed) {
  Random random(seed, "share");
  std::vector<double> log_odds;
  for (int i = 0; i < count; ++i)
    log_odds.push_back((random.bernoulli(share) ? 4.5 : -4.5) + random.normal(0, 3));
  return log_odds;  // log N(4.5, 9) - log N(-4.5, 9) at x is x
}

TEST(ClassShare, FindsTheShareThatWasDrawn) {
  for (const double share : {0.05, 0.2, 0.5, 0.9})
    EXPECT_NEAR(prior_shift(drawn(share, 5000, 1), 0.5), std::log(share / (1 - share)), 0.2) << share;
}

TEST(ClassShare, StaysWithinItsLimitsAndBelievesFewLittle) {
  EXPECT_EQ(prior_shift({}, 0.3), 0);
  EXPECT_NEAR(prior_shift(std::vector<double>(10000, -20.0), 0.5), std::log(0.02 / 0.98), 1e-9);
  EXPECT_NEAR(prior_shift(std::vector<double>(10000, 20.0), 0.5), std::log(0.98 / 0.02), 1e-9);
  EXPECT_GT(prior_shift(std::vector<double>(1, -20.0), 0.5), -1);
}

TEST(ImageFault, SaysWhatIsWrong) {
  Pixels good(20, 20, 5);
  good(3, 3) = 6;
  EXPECT_FALSE(image_fault(good, 255));
  EXPECT_NE(image_fault(good, 5)->find("100 % of the pixels of the image are saturated"), std::string::npos);
  EXPECT_NE(image_fault(Pixels(1, 1, 5), 0)->find("1 x 1"), std::string::npos);
  EXPECT_NE(image_fault(Pixels(20, 20, 5), 0)->find("all pixels of the image are 5"), std::string::npos);
  EXPECT_NE(image_fault(Pixels(20, 20, std::numeric_limits<float>::quiet_NaN()), 0)->find("no data"),
            std::string::npos);
}

}  // namespace
}  // namespace waymark::test
