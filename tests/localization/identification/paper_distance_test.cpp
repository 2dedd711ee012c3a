// SPDX-License-Identifier: Apache-2.0
// Distances of eq. 11, by the letter.
#include "localization/identification/identification.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "localization/filters/sighting_score.hpp"
#include "tests/localization/made_types.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

TEST(Paper, DistanceExcludesAssociationsWithEvidenceOfTheirOwn) {
  const LandmarkGrid map({landmark_at(10, 0, 1)});
  const SightingSet twice{{}, {seen_at(10, 0), seen_at(10.1, 0.01)}};
  IdentificationOptions options;
  options.distance = "paper";
  const auto matches = identify(twice, {}, map, {}, options).matches;
  EXPECT_EQ(std::ranges::count(matches, Verdict::matched, &Match::verdict), 2) << "eq. 10: each alone";
  for (const char* association : {"joint", "jcbb"}) {
    options.association = association;
    EXPECT_THROW(identify(twice, {}, map, {}, options), std::invalid_argument) << association;
  }
}

TEST(Paper, DistanceIsEquation11) {
  const LandmarkGrid map({landmark_at(10, 0, 1)});
  IdentificationOptions options;
  options.distance = "paper";
  const auto found = candidates(seen_at(10.1, 0.02), {}, {}, map, {}, options);
  ASSERT_EQ(found.pairings.size(), 1u);
  EXPECT_NEAR(found.pairings[0].squares, 1 + 1, 1e-9);  // one standard deviation each
}

TypeRegistry rocks() {
  TypeRegistry types;
  types.add({.name = "rock",
             .summary = "A rock",
             .features = {{"radius", "m", Scale::ratio, 0.01, 100, ""},
                          {"height", "m", Scale::ratio, 0.04, 25, ""}}});
  return types;
}

// alpha_f of eq. 11 belongs to type and feature. The landmark's own variance must not change it, or of two
// landmarks that differ as much the worse known would be the nearer.
TEST(Paper, WeightsOfEquation11AreThoseOfTheType) {
  FeatureScales scales(rocks());
  EXPECT_NEAR(scales.alpha(0, 0, 0.2), 1 / (0.2 * 1), 1e-12) << "geometric mean of 0.01 and 100";
  EXPECT_NEAR(scales.alpha(0, 1, 0.2), 1 / (0.2 * 1), 1e-12) << "of 0.04 and 25";
  EXPECT_NEAR(FeatureScales(ellipses()).alpha(0, 0, 0.2), 1 / 0.8, 1e-12) << "the reference of an axis";
  MapLandmark sure = landmark_at(10, 0, 1), vague = landmark_at(10, 0.01, 2);
  sure.features.value[0] = vague.features.value[0] = 0.5;
  sure.features.variance[0] = 1e-4, vague.features.variance[0] = 0.04;
  SeenLandmark s = seen_at(10, 0);
  s.type = TypeId{0};
  s.features.value[0] = 0.7;
  s.features.variance[0] = 0.01;
  IdentificationOptions options;
  options.distance = "paper";
  for (const double alpha : {0.0, 3.0}) {
    if (alpha > 0) set_alphas(scales, rocks(), "rock.radius=3,rock.height=1.5");
    const double by_feature = std::pow(0.2 * (alpha > 0 ? alpha : 1 / 0.15), 2);
    const auto found = candidates(s, {}, {}, LandmarkGrid({sure, vague}), scales, options).pairings;
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(found[0].squares, by_feature, 1e-9);
    EXPECT_NEAR(found[1].squares, by_feature + std::pow(0.001 / 0.02, 2), 1e-6);
    WeightOptions weights;
    weights.weights = "paper";
    const LandmarkGrid map({vague});
    EXPECT_NEAR(SightingScore({{}, {s}}, map, scales, weights, options)(Pose2{0, 0.01, 0}), by_feature, 1e-9);
  }
  EXPECT_NEAR(scales.alpha(0, 1, 0.2), 1.5, 1e-12);
}

TEST(Paper, WeightsOfEquation11AreRefusedWithAReason) {
  const auto refusal = [](const char* list) -> std::string {
    FeatureScales scales(rocks());
    try {
      set_alphas(scales, rocks(), list);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(""), "");
  EXPECT_NE(refusal("rock").find("TYPE.FEATURE=VALUE, is 'rock'"), std::string::npos);
  EXPECT_NE(refusal("stone.radius=1").find("no type 'stone'"), std::string::npos);
  EXPECT_NE(refusal("rock.mass=1").find("rock has no feature 'mass'"), std::string::npos);
  EXPECT_NE(refusal("rock.radius=-1").find("must be positive, is '-1'"), std::string::npos);
  EXPECT_NE(refusal("rock.radius=1,rock.height=x").find("must be positive, is 'x'"), std::string::npos);
}

}  // namespace
}  // namespace waymark::test
