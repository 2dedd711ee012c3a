// SPDX-License-Identifier: Apache-2.0
#include "testbed/score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "testbed/score_match.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

EvaluatedObject thing(double x, double y, double diameter) {
  EvaluatedObject t;
  t.at = {x, y};
  t.diameter = diameter;
  return t;
}

// A small false crater on the floor of a large one is no duplicate of the large one.
TEST(Score, OnlyThingsOfLikeSizeAreFoundTwice) {
  const std::vector<EvaluatedObject> truth{thing(0, 0, 80)};
  const std::vector<EvaluatedObject> found{thing(1, 0, 78), thing(20, 5, 3), thing(10, 0, 60)};
  EXPECT_EQ(score(found, truth, {}).duplicates, 1);
}

TEST(Score, CountsByHand) {
  const std::vector<EvaluatedObject> truth{thing(0, 0, 4), thing(10, 0, 4), thing(20, 0, 2)};
  const std::vector<EvaluatedObject> found{thing(1, 0, 4.4), thing(0.5, 0.5, 4), thing(30, 0, 4)};
  const Score s = score(found, truth, {}, std::vector<double>{0, 3});
  EXPECT_EQ(s.match, (std::vector<int>{-1, 0, -1}));  // the nearest is the match, the other its double
  EXPECT_EQ(s.all.truth, 3);
  EXPECT_EQ(s.all.matched, 1);
  EXPECT_EQ(s.duplicates, 1);
  EXPECT_DOUBLE_EQ(s.all.precision(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(s.all.recall(), 1.0 / 3);
  EXPECT_EQ(s.by_size[0].truth, 1);
  EXPECT_EQ(s.by_size[1].truth, 2);
  EXPECT_DOUBLE_EQ(s.position_median, std::sqrt(0.5));
}

TEST(Score, IgnoredTruthCountsNeitherWay) {
  std::vector<EvaluatedObject> truth{thing(0, 0, 4), thing(10, 0, 4)};
  truth[0].ignored = true;
  const std::vector<EvaluatedObject> found{thing(0, 0, 4), thing(10, 0, 4)};
  const Score s = score(found, truth, {});
  EXPECT_EQ(s.match, (std::vector<int>{-2, 1}));
  EXPECT_EQ(s.all.f1(), 1);
}

TEST(Score, SmallThingsAreNotAskedFor) {
  const Score s =
      score(std::vector{thing(0, 0, 3), thing(9, 9, 3)}, std::vector{thing(0, 0, 3)}, {.min_diameter = 5});
  EXPECT_EQ(s.all.truth, 0);
  EXPECT_EQ(s.all.found, 0);
  EXPECT_TRUE(std::isnan(s.all.recall()));
}

TEST(Score, SizesMustBeAlike) {
  EXPECT_EQ(score(std::vector{thing(0, 0, 1)}, std::vector{thing(0, 0, 10)}, {}).all.matched, 0);
  EXPECT_EQ(score(std::vector{thing(0, 0, 1)}, std::vector{thing(0, 0, 10)}, {.size_ratio = 0}).all.matched,
            1);
}

TEST(Score, OverlapOfCircles) {
  EXPECT_DOUBLE_EQ(circle_overlap(0, 2, 2), 1);
  EXPECT_DOUBLE_EQ(circle_overlap(0, 2, 4), 0.25);
  EXPECT_DOUBLE_EQ(circle_overlap(3, 2, 4), 0);
  EXPECT_NEAR(circle_overlap(1, 2, 2), 0.243, 1e-3);  // lens 1.2284 of 2 pi - 1.2284
}

TEST(Score, ByOverlapTheMostConfidentComesFirst) {
  std::vector<EvaluatedObject> found{thing(0.2, 0, 10), thing(0.5, 0, 10)};
  found[0].confidence = 0.5, found[1].confidence = 0.9;
  const Score s = score(found, std::vector{thing(0, 0, 10)}, {.by = MatchRules::By::overlap});
  EXPECT_EQ(s.match, (std::vector<int>{-1, 0}));
  EXPECT_DOUBLE_EQ(s.average_precision, 1);  // the right one is ranked first
}

TEST(Score, EllipsesAndCalibration) {
  std::vector<EvaluatedObject> found, truth;
  for (int i = 0; i < 10; ++i) {
    found.push_back(thing(100.0 * i + (i < 9 ? 1 : 3), 0, 20));
    found.back().covariance = Eigen::Matrix2d::Identity();
    found.back().confidence = 0.85;
    if (i != 5) truth.push_back(thing(100.0 * i, 0, 20));
  }
  const Score s = score(found, truth, {});
  EXPECT_EQ(s.with_covariance, 9);
  EXPECT_NEAR(s.inside_90, 8.0 / 9, 1e-12);  // 3 sd is outside
  EXPECT_NEAR(s.nees, (8 * 1 + 9) / 9.0, 1e-12);
  EXPECT_NEAR(s.nees_median, 1, 1e-12) << "one wrong pair does not change it";
  EXPECT_NEAR(s.confidence_error, std::abs(0.85 - 0.9), 1e-12);
}

TEST(Score, FeaturesAreComparedByName) {
  std::vector<EvaluatedObject> found{thing(0, 0, 4)}, truth{thing(0, 0, 5)};
  found[0].features = {{"height", 1.1}, {"other", 3}};
  truth[0].features = {{"height", 1.0}};
  const Score s = score(found, truth, {});
  EXPECT_NEAR(s.features.at("height").relative_bias, 0.1, 1e-12);
  EXPECT_NEAR(s.features.at("diameter").bias, -1, 1e-12);
  EXPECT_FALSE(s.features.contains("other"));
}

TEST(Score, AFeatureNamedDiameterIsNotThatOfTheCircle) {
  std::vector<EvaluatedObject> found{thing(0, 0, 4)}, truth{thing(0, 0, 5)};
  found[0].features = {{"diameter", 0.3}};
  truth[0].features = {{"diameter", 0.2}};
  const Score s = score(found, truth, {});
  EXPECT_EQ(s.features.at("diameter").count, 1);
  EXPECT_NEAR(s.features.at("diameter").bias, 0.1, 1e-12) << "a stem, not its crown";
}

TEST(Score, DeviationsOfFeaturesAreChecked) {
  std::vector<EvaluatedObject> found, truth;
  for (int i = 0; i < 4; ++i) {
    found.push_back(thing(100.0 * i, 0, 20));
    truth.push_back(thing(100.0 * i, 0, 20));
    found.back().features = {{"height", 1 + 0.2 * i}, {"orientation", 3.1}};
    truth.back().features = {{"height", 1}, {"orientation", 0}};
    if (i < 3) found.back().deviations = {{"height", 0.2}, {"orientation", 0.05}};
  }
  const MatchRules rules{.scales = {{"orientation", Scale::axis}}};
  const Score s = score(found, truth, rules);
  EXPECT_EQ(s.features.at("height").with_deviation, 3);
  EXPECT_NEAR(s.features.at("height").inside_90, 2.0 / 3, 1e-12) << "2 deviations are outside";
  EXPECT_NEAR(s.features.at("orientation").inside_90, 1, 1e-12) << "half a turn is none";
  EXPECT_EQ(s.features.at("diameter").with_deviation, 0);
  EXPECT_TRUE(std::isnan(s.features.at("diameter").inside_90));
}

TEST(Score, AnAxisErrsByAQuarterTurnAtMostAndAnElevationHasNoPercentage) {
  std::vector<EvaluatedObject> found{thing(0, 0, 4)}, truth{thing(0, 0, 4)};
  found[0].features = {{"orientation", 3.1}, {"elevation", 12}};
  truth[0].features = {{"orientation", 0.1}, {"elevation", 10}};
  const MatchRules rules{.scales = {{"orientation", Scale::axis}, {"elevation", Scale::interval}}};
  const Score s = score(found, truth, rules);
  EXPECT_NEAR(s.features.at("orientation").bias, 3 - std::numbers::pi, 1e-12);
  EXPECT_TRUE(std::isnan(s.features.at("orientation").relative_bias));
  EXPECT_NEAR(s.features.at("elevation").bias, 2, 1e-12);
  EXPECT_TRUE(std::isnan(s.features.at("elevation").relative_bias));
}

TEST(Score, NothingAgainstNothing) {
  const Score s = score({}, {}, {});
  EXPECT_TRUE(std::isnan(s.all.f1()));
  EXPECT_TRUE(std::isnan(s.inside_90));
}

}  // namespace
}  // namespace waymark::test
