// SPDX-License-Identifier: Apache-2.0
#include "core/feature.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace waymark::test {
namespace {

constexpr double kDegree = kRadiansPerDegree;

TEST(MergeFeature, WeighsObservationsByQuality) {
  const WeightedValue seen[] = {{1.0, 0.9}, {2.0, 0.1}};
  EXPECT_NEAR(merge(seen, Scale::ratio).value, 1.1, 1e-12);
}

TEST(MergeFeature, AxesNearTheWrapAverageToTheWrap) {
  const WeightedValue seen[] = {{1 * kDegree, 1}, {179 * kDegree, 1}};
  const FeatureValue axis = merge(seen, Scale::axis);
  EXPECT_NEAR(std::remainder(axis.value, 180 * kDegree), 0, 1e-12);
  EXPECT_NEAR(std::sqrt(axis.variance), std::sqrt(2.0) * kDegree, 1e-12);
}

TEST(MergeFeature, ThePapersMeanWouldTurnThatAxisByARightAngle) {
  const WeightedValue seen[] = {{1 * kDegree, 1}, {179 * kDegree, 1}};
  EXPECT_NEAR(merge(seen, Scale::ratio).value, 90 * kDegree, 1e-12);
}

TEST(MergeFeature, CrossedAxesHaveNoMeanAndGiveTheFirst) {
  const WeightedValue seen[] = {{30 * kDegree, 1}, {120 * kDegree, 1}};
  EXPECT_EQ(merge(seen, Scale::axis).value, 30 * kDegree);
}

TEST(MergeFeature, DirectionsNearTheWrapAverageToTheWrap) {
  const WeightedValue seen[] = {{-179 * kDegree, 1}, {179 * kDegree, 1}};
  const FeatureValue direction = merge(seen, Scale::direction);
  EXPECT_NEAR(std::abs(direction.value), 180 * kDegree, 1e-12);
  EXPECT_NEAR(std::sqrt(direction.variance), std::sqrt(2.0) * kDegree, 1e-12);
}

TEST(MergeFeature, OppositeDirectionsHaveNoMeanAndGiveTheFirst) {
  const WeightedValue seen[] = {{30 * kDegree, 1}, {-150 * kDegree, 1}};
  EXPECT_EQ(merge(seen, Scale::direction).value, 30 * kDegree);
  EXPECT_NEAR(merge(seen, Scale::axis).variance, 0, 1e-12) << "but they are one axis";
}

TEST(MergeFeature, OneObservationHasNoSpread) {
  const WeightedValue seen[] = {{3.0, 0.5}};
  const FeatureValue merged = merge(seen, Scale::ratio);
  EXPECT_EQ(merged.value, 3);
  EXPECT_EQ(merged.variance, 0);
  EXPECT_EQ(merged.observations, 1);
}

TEST(MergeFeature, EqualWeightsGiveTheSampleVariance) {
  const WeightedValue seen[] = {{1, 0.3}, {2, 0.3}, {6, 0.3}};
  EXPECT_NEAR(merge(seen, Scale::ratio).variance, 7.0, 1e-12);
}

TEST(MergeFeature, AnAbsentValueIsNotKnown) {
  EXPECT_FALSE(FeatureValue{}.known());
}

std::vector<WeightedValue> some_values() {
  std::vector<WeightedValue> seen;
  const int count = *rc::gen::inRange(1, 12);
  for (int i = 0; i < count; ++i)
    seen.push_back({0.01 * *rc::gen::inRange(-1000, 1000), 0.01 * *rc::gen::inRange(1, 100)});
  return seen;
}

RC_GTEST_PROP(MergeFeature, LiesBetweenTheObservations, ()) {
  const auto seen = some_values();
  const double value = merge(seen, Scale::ratio).value;
  const auto [low, high] = std::ranges::minmax(seen, {}, &WeightedValue::value);
  RC_ASSERT(value >= low.value - 1e-9);
  RC_ASSERT(value <= high.value + 1e-9);
}

RC_GTEST_PROP(MergeFeature, DoesNotDependOnOrderOrOnTheUnitOfWeights, ()) {
  auto seen = some_values();
  for (const Scale scale : {Scale::ratio, Scale::interval}) {
    const FeatureValue merged = merge(seen, scale);
    auto other = seen;
    std::ranges::reverse(other);
    for (auto& s : other) s.weight *= 8;
    const FeatureValue again = merge(other, scale);
    RC_ASSERT(std::abs(merged.value - again.value) < 1e-9);
    RC_ASSERT(std::abs(merged.variance - again.variance) < 1e-6);
  }
}

RC_GTEST_PROP(MergeFeature, TurningEveryAngleTurnsTheMean, ()) {
  std::vector<WeightedValue> seen;
  for (int i = 0; i < 5; ++i) seen.push_back({*rc::gen::inRange(-40, 40) * kDegree, 1});
  auto turned = seen;
  const double by = *rc::gen::inRange(-720, 720) * kDegree;
  for (auto& s : turned) s.value += by;
  for (const Scale scale : {Scale::axis, Scale::direction}) {
    const double moved = merge(turned, scale).value - merge(seen, scale).value;
    RC_ASSERT(std::abs(difference(moved, by, scale)) < 1e-9);
  }
}

}  // namespace
}  // namespace waymark::test
