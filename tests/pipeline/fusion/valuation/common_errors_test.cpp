// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/common_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/fusion/valuation/landmark_valuation.hpp"
#include "tests/pipeline/fusion/own_types.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const LandmarkType& rock_type() {
  return kTypes[kTypes.id("rock")];
}

Landmark rock_seen(int observations, double variance) {
  Landmark l;
  l.uid = "rock-1";
  l.type = kTypes.id("rock");
  l.features = {{2, variance, observations}, {}};
  return l;
}

double radius_variance(int observations, double variance, double gsd) {
  Landmark l = rock_seen(observations, variance);
  add_common_errors(l, rock_type(), gsd);
  EXPECT_FALSE(l.features[1].known());
  return l.features[0].variance;
}

TEST(CommonErrors, DoNotShrinkWithObservations) {
  const double common = 0.18 * 0.18 + 0.028 * 0.028;  // 0.09 x 2 m and 0.28 pixels of 0.1 m
  EXPECT_NEAR(radius_variance(4, 0.04, 0.1), 0.01 + common, 1e-12);
  EXPECT_NEAR(radius_variance(1000000, 0.04, 0.1), common, 1e-6);
  EXPECT_NEAR(radius_variance(1, 0.04, 0.1), 0.04 + common, 1e-12) << "as the observation states it";
  EXPECT_NEAR(radius_variance(4, 0.04, std::nan("")), 0.01 + 0.18 * 0.18, 1e-12);
  EXPECT_EQ(radius_variance(1, 0, 0.1), 0) << "unknown stays unknown";
}

// Shadows on ground of unknown slope; the lower the sun, the more they depend on it.
TEST(CommonErrors, HeightsOnGroundOfUnknownSlopeAreLessCertain) {
  ImageView image;
  image.name = "a";
  image.gsd = 0.1;
  const auto height_variance = [&](double elevation, double height_of_ground_variance) {
    image.sun = Sun{Degrees{90}, Degrees{elevation}, Degrees{0.5}};
    Landmark l = rock_seen(2, 0.04);
    l.features[1] = {3, 0.09, 2};
    l.covariance(2, 2) = height_of_ground_variance;
    std::vector<Observation> evidence(1);
    evidence[0].type = l.type;
    evidence[0].source = "a";
    evidence[0].landmark_uid = l.uid;
    value_landmarks({&l, 1}, evidence, {&image, 1}, nullptr, kTypes, 1);
    return l.features[1].variance;
  };
  const double known = height_variance(20, 0.01), slope = 0.04 * 3 / std::tan(to_radians(Degrees{20}).value);
  EXPECT_NEAR(height_variance(60, 0.01), known, 1e-12);
  EXPECT_NEAR(height_variance(20, std::nan("")), known + slope * slope, 1e-12);
  EXPECT_LT(height_variance(60, std::nan("")), known + 0.2 * slope * slope);
}

TEST(CommonErrors, OthersStayAsTheyAre) {
  EXPECT_FALSE(common_error(EvidenceModel::canopy, "height"));
  EXPECT_FALSE(common_error(EvidenceModel::bowl, "orientation"));
  EXPECT_TRUE(common_error(EvidenceModel::bowl, "depth"));
}

Landmark crater_with_axes(double major, double minor, double variance) {
  Landmark l;
  l.type = kTypes.id("crater");
  l.features = {{(major + minor) / 4, 0.01, 4}, {}, {major, 0.01, 4}, {minor, 0.01, 4}, {0.3, variance, 4}};
  add_common_errors(l, kTypes[l.type], 0.1);
  return l;
}

// Observations agree on the direction of a rim that is round: they share one sun.
TEST(CommonErrors, OrientationsOfRoundRimsAreUnknown) {
  const double unknown = std::numbers::pi * std::numbers::pi / 12;
  EXPECT_NEAR(crater_with_axes(10, 10, 0.01).features[4].variance, unknown, 1e-9);
  EXPECT_GT(crater_with_axes(10.5, 10, 0.01).features[4].variance, 0.8 * unknown);
  EXPECT_NEAR(std::sqrt(crater_with_axes(20, 10, 0.01).features[4].variance), 0.16, 0.02);
  EXPECT_LE(crater_with_axes(11, 10, 9).features[4].variance, unknown + 1e-9) << "no direction is less known";
  EXPECT_EQ(crater_with_axes(std::nan(""), 10, 0.04).features[4].variance, 0.04) << "without axes as stated";
}

TEST(CommonErrors, AreThoseOfTheFinestImageAndLeaveQualityAsItIs) {
  std::vector<ImageView> images(2);
  images[0].name = "coarse", images[0].gsd = 0.8;
  images[1].name = "fine", images[1].gsd = 0.2;
  std::vector<Observation> evidence(2);
  for (std::size_t i = 0; i < 2; ++i) {
    evidence[i].type = kTypes.id("rock");
    evidence[i].source = images[i].name;
    evidence[i].landmark_uid = "rock-1";
  }
  const auto valued = [&](const ValuationRules& rules) {
    Landmark l = rock_seen(2, 0.04);
    value_landmarks({&l, 1}, evidence, images, nullptr, kTypes, 1, rules);
    return l;
  };
  const Landmark l = valued({});
  EXPECT_NEAR(l.features[0].variance, 0.02 + 0.18 * 0.18 + 0.056 * 0.056, 1e-12);
  EXPECT_NEAR(l.quality.feature_confidences[0].value(), 0.9, 1e-12) << "the spread, 0.2 of 2 m";
  const Landmark literal = valued({.spread = SpreadRule::paper});
  EXPECT_NEAR(literal.features[0].variance, 0.04, 1e-12) << "the paper's variance is that of eq. 6";
  evidence[0].source = evidence[1].source = "a catalogue";
  EXPECT_NEAR(valued({}).features[0].variance, 0.04, 1e-12) << "no image, no sun";
}

}  // namespace
}  // namespace waymark::test
