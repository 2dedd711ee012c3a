// SPDX-License-Identifier: Apache-2.0
#include "core/landmark.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>

namespace waymark::test {
namespace {

constexpr FeatureValue kRadius{2.0, 0.25, 4};          // s = 0.5
constexpr FeatureValue kMarsSummit{-2000.0, 25.0, 4};  // s = 5
constexpr FeatureValue kSeenOnce{2.0, 0, 1};

TEST(Multiplicity, IsTheFractionOfImagesThatDetectIt) {
  EXPECT_EQ(multiplicity_confidence(3, 4), 0.75);
  EXPECT_EQ(multiplicity_confidence(5, 4), 1.0);  // seen in a coarser image too
  EXPECT_EQ(multiplicity_confidence(0, 0), std::nullopt);
}

TEST(SpreadConfidence, OfARatioIsOneLessTheCoefficientOfVariation) {
  EXPECT_NEAR(*spread_confidence(kRadius, Scale::ratio, 0), 0.75, 1e-12);
  EXPECT_NEAR(*spread_confidence(kRadius, Scale::ratio, 0, SpreadRule::paper), 0.75, 1e-12);
}

// Eq. 6 divides by the mean: a spread of 5 m at -2000 m gives a confidence above 1, clamped to 1; near height
// 0 it gives none.
TEST(SpreadConfidence, OfAnElevationUsesTheReferenceAndNotTheDatum) {
  EXPECT_NEAR(*spread_confidence(kMarsSummit, Scale::interval, 100), 0.95, 1e-12);
  FeatureValue at_datum = kMarsSummit;
  at_datum.value = 0;
  EXPECT_NEAR(*spread_confidence(at_datum, Scale::interval, 100), 0.95, 1e-12);
  EXPECT_EQ(*spread_confidence(kMarsSummit, Scale::interval, 100, SpreadRule::paper), 1.0);
  EXPECT_EQ(spread_confidence(at_datum, Scale::interval, 100, SpreadRule::paper), std::nullopt);
}

TEST(SpreadConfidence, OfOneObservationIsAbsent) {
  EXPECT_EQ(spread_confidence(kSeenOnce, Scale::ratio, 0), std::nullopt);
  EXPECT_EQ(*spread_confidence(kSeenOnce, Scale::ratio, 0, SpreadRule::paper), 1.0);
  EXPECT_EQ(spread_confidence(FeatureValue{}, Scale::ratio, 0, SpreadRule::paper), std::nullopt);
  const FeatureValue stated{2.0, 0.25, 1};  // the detector's own deviation is no spread of observations
  EXPECT_EQ(spread_confidence(stated, Scale::ratio, 0), std::nullopt);
  EXPECT_EQ(*spread_confidence(stated, Scale::ratio, 0, SpreadRule::paper), 1.0);
}

TEST(SpreadConfidence, WithoutAReferenceIsAbsentAndNotInfinite) {
  EXPECT_EQ(spread_confidence(kMarsSummit, Scale::interval, 0), std::nullopt);
  EXPECT_EQ(spread_confidence({0, 1, 3}, Scale::ratio, 0), std::nullopt);
}

TEST(LandmarkQuality, IsMultiplicityTimesTheWeightedMean) {
  const std::array<std::optional<double>, 2> q{0.5, 1.0};
  EXPECT_NEAR(*landmark_quality(0.8, q, std::array{0.25, 0.75}), 0.8 * 0.875, 1e-12);
  EXPECT_NEAR(*landmark_quality(0.8, q, std::array{1.0, 3.0}), 0.8 * 0.875, 1e-12);
}

TEST(LandmarkQuality, AFeatureObservedOnceIsLeftOut) {
  const std::array<std::optional<double>, 2> q{0.5, std::nullopt};
  EXPECT_NEAR(*landmark_quality(1.0, q, std::array{0.5, 0.5}), 0.5, 1e-12);
  const std::array<std::optional<double>, 1> none{std::nullopt};
  EXPECT_EQ(landmark_quality(0.7, none, std::array{1.0}), 0.7);
  EXPECT_EQ(landmark_quality(std::nullopt, none, std::array{1.0}), std::nullopt);
}

TEST(LandmarkQuality, WeightsOfZeroLeaveTheMultiplicity) {
  const std::array<std::optional<double>, 1> q{0.1};
  EXPECT_EQ(landmark_quality(0.7, q, std::array{0.0}), 0.7);
}

RC_GTEST_PROP(SpreadConfidence, StaysBetweenZeroAndOne, ()) {
  const FeatureValue f{0.1 * *rc::gen::inRange(-1000, 1000), 0.1 * *rc::gen::inRange(0, 10000),
                       *rc::gen::inRange(0, 5)};
  for (const Scale scale : {Scale::ratio, Scale::interval, Scale::axis})
    for (const SpreadRule rule : {SpreadRule::sound, SpreadRule::paper}) {
      const auto q = spread_confidence(f, scale, 3.0, rule);
      if (q) RC_ASSERT(*q >= 0 && *q <= 1);
    }
}

}  // namespace
}  // namespace waymark::test
