// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/detection_rates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace waymark::test {
using namespace localization;
namespace {

constexpr TypeId kPole = 1, kSign = 2;

/// Returns the log probability of `misses` in a row, as SLAM adds them.
double log_misses(const DetectionRates& rates, TypeId type, double range, int misses) {
  RangeViews views;
  double sum = 0;
  for (int i = 0; i < misses; ++i) {
    sum += rates.log_miss(type, range, views);
    views.add(range, false);
  }
  return sum;
}

TEST(DetectionRates, ReachThatOfEachTypeAndOfSightingsWithoutOne) {
  DetectionRates rates;
  EXPECT_EQ(rates.reach(kPole), 0) << "nothing was seen";
  rates.note(kSign, 30);
  rates.note(kPole, 12);
  rates.note(kPole, 8);
  EXPECT_EQ(rates.reach(kPole), 12);
  EXPECT_EQ(rates.reach(TypeId{7}), 0);
  EXPECT_EQ(rates.reach({}), 30) << "a landmark of no type may be anything";
  rates.note({}, 20);
  EXPECT_EQ(rates.reach(kPole), 20) << "a sighting of no type may be a pole";
}

// The rates are those of the chain that the views were drawn from.
TEST(DetectionRates, LearnHowOftenAMissFollowsAMiss) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  DetectionRates rates;
  for (int landmark = 0; landmark < 200; ++landmark) {
    RangeViews views;
    for (int view = 0; view < 50; ++view) views.add(10, any(random) > (views.last_seen ? 0.1 : 0.9));
    rates.learn(kPole, views);
  }
  RangeViews after_seen;
  after_seen.add(3, true);
  EXPECT_NEAR(std::exp(rates.log_miss(kPole, 10, {})), 0.9, 0.02);
  EXPECT_NEAR(std::exp(rates.log_miss(kPole, 10, after_seen)), 0.1, 0.02);
  EXPECT_NEAR(std::exp(rates.log_miss(kPole, 30, {})), 0.5, 1e-9) << "nothing is known of this range";
  EXPECT_NEAR(std::exp(rates.log_miss(kSign, 10, {})), 0.5, 1e-9);
}

TEST(DetectionRates, OfRunsOfMissesSayLessAndLess) {
  DetectionRates rates;
  RangeViews far, near;
  for (int view = 0; view < 100; ++view) far.add(20, view % 20 == 0), near.add(4, view % 10 != 0);
  rates.learn(kPole, far);
  rates.learn(kPole, near);
  EXPECT_GT(log_misses(rates, kPole, 20, 100), -0.6) << "seldom seen so far away";
  EXPECT_LT(log_misses(rates, kPole, 4, 10), -3) << "it would be seen";
  EXPECT_LT(log_misses(rates, kPole, 4, 20) - log_misses(rates, kPole, 4, 10), -0.3);
  EXPECT_GT(log_misses(rates, kPole, 4, 20) - log_misses(rates, kPole, 4, 10), -1);
}

TEST(DetectionRates, HoldAnyRange) {
  DetectionRates rates;
  RangeViews views;
  for (const double range : {0.0, 0.5, 1.0, 1e6}) views.add(range, true);
  rates.learn(kPole, views);
  for (const double range : {0.0, 1.0, 63.0, 1e6}) EXPECT_LE(rates.log_miss(kPole, range, views), 0) << range;
}

}  // namespace
}  // namespace waymark::test
