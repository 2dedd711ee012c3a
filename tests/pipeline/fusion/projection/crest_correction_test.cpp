// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/crest_correction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/fusion/projection/detection_projection.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// Returns the state whose depth is next to the requested one.
DegradationProfiles::State state_of_depth(double depth) {
  DegradationProfiles::State best = DegradationProfiles::instance().states().front();
  for (const auto& state : DegradationProfiles::instance().states())
    if (std::abs(state.depth - depth) < std::abs(best.depth - depth)) best = state;
  return best;
}

// Returns ln(crest / outline) for outlines of the built-in detector.
double growth_of(const DegradationProfiles::State& state) {
  return 0.65 * std::max(0.0, state.crest_over_edge - 0.045);
}

// Crater in the centre of ground rising by 0.1 to the east, heights every metre.
Terrain ground(double crest_diameter, const DegradationProfiles::State& state, double fraction = 1) {
  Grid<float> heights(161, 161);
  const double fresh = crest_diameter / 2 / state.crest;
  for (std::int64_t r = 0; r < 161; ++r)
    for (std::int64_t c = 0; c < 161; ++c) {
      const double x = double(c - 80), y = double(80 - r);
      heights(c, r) = static_cast<float>(
          0.1 * x + fraction * 2 * fresh *
                        DegradationProfiles::instance().height(std::hypot(state.blur, 0.3 / fresh),
                                                               std::hypot(x, y) / fresh));
    }
  return {std::move(heights), -80, 80, 1, 1};
}

GroundOutline circle(double diameter) {
  return {.centre = {0, 0, 0}, .major = diameter, .minor = diameter, .orientation = 0};
}

TEST(DegradationProfiles, AreSmoothedByAGaussian) {
  const DegradationProfiles& worn = DegradationProfiles::instance();
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

TEST(DegradationProfiles, WearMakesShallowAndSpreadsTheCrest) {
  const auto& states = DegradationProfiles::instance().states();
  EXPECT_NEAR(states.front().depth, 0.2, 1e-6);
  EXPECT_NEAR(states.front().crest_over_edge, 0, 1e-6);
  for (std::size_t i = 1; i < states.size(); ++i) {
    EXPECT_LT(states[i].depth, states[i - 1].depth);
    EXPECT_GE(states[i].crest, states[i - 1].crest);
  }
  // docs/methods/craters.md: brightness makes the most degraded craters at least a quarter too narrow.
  EXPECT_NEAR(state_of_depth(0.1).crest_over_edge, 0.3, 0.05);
}

// Cells of 1 m hold the mean of 9 x 9 heights; the crater is in the middle, `offset` from a cell's centre.
Terrain averaged_ground(double crest_diameter, const DegradationProfiles::State& state, double offset) {
  Grid<float> heights(81, 81);
  const double fresh = crest_diameter / 2 / state.crest;
  for (std::int64_t r = 0; r < 81; ++r)
    for (std::int64_t c = 0; c < 81; ++c) {
      double sum = 0;
      for (int i = 0; i < 81; ++i) {
        const double x = double(c - 40) + (i % 9 - 4) / 9.0 + offset;
        const double y = double(40 - r) + (i / 9 - 4) / 9.0 - offset;
        sum += 2 * fresh * DegradationProfiles::instance().height(state.blur, std::hypot(x, y) / fresh);
      }
      heights(c, r) = static_cast<float>(sum / 81);
    }
  return {std::move(heights), -40 + offset, 40 - offset, 1, 1};
}

// Median over azimuths of the highest point near the crest, minus the floor, in diameters.
double shown_depth(const Terrain& terrain, double diameter) {
  std::vector<double> crests;
  double floor = 0;
  for (int k = 0; k < 36; ++k) {
    const double t = 2 * std::numbers::pi * k / 36;
    const auto height = [&](double fraction) {
      const double r = fraction * diameter / 2;
      return terrain.height(r * std::cos(t), r * std::sin(t)).value();
    };
    double crest = -1e9;
    for (const double fraction : {0.9, 0.94, 0.98, 1.02, 1.06, 1.1})
      crest = std::max(crest, height(fraction));
    crests.push_back(crest);
    floor += height(0.06) / 36;
  }
  std::ranges::nth_element(crests, crests.begin() + 18);
  return (crests[18] - floor) / diameter;
}

// Bilinear heights smooth least at a cell's centre and most between cells, so 6 % at 5.5 cells are left.
TEST(DepthGrowth, GivesBackTheDepthThatCellsTake) {
  for (const double depth : {0.19, 0.15, 0.1, 0.06})
    for (const double diameter : {5.5, 8.0, 16.0}) {
      const auto state = state_of_depth(depth);
      double before = 0, after = 0;  // mean fraction of the true depth
      for (const double offset : {0.0, 0.25, 0.5}) {
        const double shown = shown_depth(averaged_ground(diameter, state, offset), diameter);
        before += shown / state.depth / 3;
        after += shown * depth_growth(shown, diameter) / state.depth / 3;
      }
      EXPECT_NEAR(after, 1, diameter < 6 ? 0.06 : 0.03) << depth << ", " << diameter << " m";
      EXPECT_LT(std::abs(after - 1), std::abs(before - 1) / 2) << depth << ", " << diameter << " m";
    }
}

TEST(DepthGrowth, IsOneWhereNothingIsTakenOrShown) {
  EXPECT_EQ(depth_growth(0, 8), 1);
  EXPECT_EQ(depth_growth(-0.1, 8), 1);
  EXPECT_EQ(depth_growth(std::nan(""), 8), 1);
  EXPECT_NEAR(depth_growth(0.1, 1000), 1, 0.01);
  EXPECT_LT(depth_growth(0.4, 5), 1.25);  // deeper than any crater
}

TEST(CrestCorrection, IsFoundByTheDepthTheHeightsShow) {
  for (const double depth : {0.19, 0.15, 0.11, 0.08})
    for (const double diameter : {6.0, 12.0, 30.0}) {
      const auto state = state_of_depth(depth);
      const double growth = growth_of(state);
      const auto crest =
          crest_correction(ground(diameter, state), circle(diameter * std::exp(-growth)), 0.65);
      ASSERT_TRUE(crest);
      EXPECT_NEAR(crest->growth, growth, 0.025) << depth << ", " << diameter << " m";
      EXPECT_GT(crest->growth_sd, 0.05);
    }
}

TEST(CrestCorrection, HeightsMoveTheCrestOffTheLaw) {
  for (const double depth : {0.15, 0.11})
    for (const double off : {-0.09, 0.09}) {
      const auto state = state_of_depth(depth);
      const double growth = growth_of(state) + off;
      const auto crest = crest_correction(ground(20, state), circle(20 * std::exp(-growth)), 0.65);
      ASSERT_TRUE(crest);
      EXPECT_NEAR(crest->growth, growth, 0.03) << depth << ", off by " << off;
    }
}

TEST(CrestCorrection, SaysNothingOfWhatTheHeightsDoNotResolve) {
  const auto state = state_of_depth(0.1);
  const auto flat = crest_correction(ground(12, state, 0), circle(12), 0.65);
  ASSERT_TRUE(flat);
  EXPECT_LT(flat->growth, 0.01);
  EXPECT_FALSE(crest_correction(ground(12, state), circle(2.9), 0.65));
  EXPECT_FALSE(crest_correction(ground(12, state), circle(100), 0.65));  // beyond the heights
}

TEST(CrestCorrection, CratersOfImagesArePlacedByTheirCrests) {
  TypeRegistry types;
  register_landmark_types(types);
  const LandmarkType& type = *types.find("crater");
  const auto state = state_of_depth(0.1);
  ImageView image;
  image.columns = image.rows = 320;
  image.ortho = OrthoGrid{-80, 80, 0.5, -0.5};
  Detection seen;
  seen.type = types.id("crater");
  const double pixels = 40 * std::exp(-growth_of(state));  // of a crest of 20 m
  seen.outline = {160, 160, pixels, pixels, 0};
  const Terrain terrain = ground(20, state);
  const auto diameter = [&](const ProjectionRules& rules) {
    return 2 *
           project_detection(seen, image, terrain, type, rules).features[feature_index(type, "radius")].value;
  };
  EXPECT_NEAR(diameter({}), 20, 0.5);
  EXPECT_NEAR(diameter({.outline_edge_fraction = 0}), pixels / 2, 0.1);
  EXPECT_NEAR(diameter({.heights_known = false}), pixels / 2, 0.1);
}

}  // namespace
}  // namespace waymark::test
