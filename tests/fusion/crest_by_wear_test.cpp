// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/crest_by_wear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/fusion/placing.hpp"
#include "pipeline/fusion/worn_profiles.hpp"

namespace waymark::testing {
namespace {

// The wear whose depth is next to the one asked for.
WornProfiles::Wear wear_of(double depth) {
  WornProfiles::Wear best = WornProfiles::instance().wears().front();
  for (const auto& wear : WornProfiles::instance().wears())
    if (std::abs(wear.depth - depth) < std::abs(best.depth - depth)) best = wear;
  return best;
}

// ln(crest / outline) as our detector draws outlines.
double growth_of(const WornProfiles::Wear& wear) {
  return 0.65 * std::max(0.0, wear.crest_over_edge - 0.045);
}

// A crater in the middle of ground that rises by 0.1 to the east, heights every metre.
Terrain ground(double crest_diameter, const WornProfiles::Wear& wear, double share = 1) {
  Grid<float> heights(161, 161);
  const double fresh = crest_diameter / 2 / wear.crest;
  for (std::int64_t r = 0; r < 161; ++r)
    for (std::int64_t c = 0; c < 161; ++c) {
      const double x = double(c - 80), y = double(80 - r);
      heights(c, r) =
          static_cast<float>(0.1 * x + share * 2 * fresh *
                                           WornProfiles::instance().height(std::hypot(wear.blur, 0.3 / fresh),
                                                                           std::hypot(x, y) / fresh));
    }
  return {std::move(heights), -80, 80, 1, 1};
}

GroundOutline circle(double diameter) {
  return {.centre = {0, 0, 0}, .major = diameter, .minor = diameter, .orientation = 0};
}

TEST(WornProfiles, AreSmoothedByAGaussian) {
  const WornProfiles& worn = WornProfiles::instance();
  constexpr double kStep = 0.02;
  for (const double blur : {0.15, 0.4, 0.9})
    for (const double r : {0.0, 0.7, 1.2, 2.0}) {
      double sum = 0, weights = 0;
      for (double y = -5 * blur; y <= 5 * blur; y += kStep)
        for (double x = -5 * blur; x <= 5 * blur; x += kStep) {
          const double weight = std::exp(-(x * x + y * y) / (2 * blur * blur));
          sum += weight * worn.height(0, std::hypot(r + x, y)), weights += weight;
        }
      EXPECT_NEAR(worn.height(blur, r), sum / weights, 0.001) << blur << " at " << r;
    }
}

TEST(WornProfiles, WearMakesShallowAndSpreadsTheCrest) {
  const auto& wears = WornProfiles::instance().wears();
  EXPECT_NEAR(wears.front().depth, 0.2, 1e-6);
  EXPECT_NEAR(wears.front().crest_over_edge, 0, 1e-6);
  for (std::size_t i = 1; i < wears.size(); ++i) {
    EXPECT_LT(wears[i].depth, wears[i - 1].depth);
    EXPECT_GE(wears[i].crest, wears[i - 1].crest);
  }
  // docs/craters.md: what brightness shows of the most worn craters is a quarter too narrow and more.
  EXPECT_NEAR(wear_of(0.1).crest_over_edge, 0.3, 0.05);
}

TEST(CrestByWear, IsFoundByTheDepthTheHeightsShow) {
  for (const double depth : {0.19, 0.15, 0.11, 0.08})
    for (const double diameter : {6.0, 12.0, 30.0}) {
      const auto wear = wear_of(depth);
      const double growth = growth_of(wear);
      const auto crest = crest_by_wear(ground(diameter, wear), circle(diameter * std::exp(-growth)), 0.65);
      ASSERT_TRUE(crest);
      EXPECT_NEAR(crest->growth, growth, 0.025) << depth << ", " << diameter << " m";
      EXPECT_GT(crest->growth_sd, 0.05);
    }
}

TEST(CrestByWear, SaysNothingOfWhatTheHeightsDoNotResolve) {
  const auto wear = wear_of(0.1);
  const auto flat = crest_by_wear(ground(12, wear, 0), circle(12), 0.65);
  ASSERT_TRUE(flat);
  EXPECT_LT(flat->growth, 0.01);
  EXPECT_FALSE(crest_by_wear(ground(12, wear), circle(2.9), 0.65));
  EXPECT_FALSE(crest_by_wear(ground(12, wear), circle(100), 0.65));  // beyond the heights
}

TEST(CrestByWear, CratersOfImagesArePlacedByTheirCrests) {
  TypeRegistry types;
  register_landmark_types(types);
  const LandmarkType& type = *types.find("crater");
  const auto wear = wear_of(0.1);
  ImageView image;
  image.columns = image.rows = 320;
  image.ortho = OrthoGrid{-80, 80, 0.5, -0.5};
  Detection seen;
  seen.type = types.id("crater");
  const double pixels = 40 * std::exp(-growth_of(wear));  // of a crest of 20 m
  seen.outline = {160, 160, pixels, pixels, 0};
  const Terrain terrain = ground(20, wear);
  const auto diameter = [&](const PlacingRules& rules) {
    return 2 * placed(seen, image, terrain, type, rules).features[feature_index(type, "radius")].value;
  };
  EXPECT_NEAR(diameter({}), 20, 0.5);
  EXPECT_NEAR(diameter({.edge_share = 0}), pixels / 2, 0.1);
  EXPECT_NEAR(diameter({.heights_known = false}), pixels / 2, 0.1);
}

}  // namespace
}  // namespace waymark::testing
