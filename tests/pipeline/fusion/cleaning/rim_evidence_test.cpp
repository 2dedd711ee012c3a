// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/rim_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/pipeline/fusion/made_landing.hpp"
#include "tests/pipeline/fusion/own_types.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// Ground rising to the north, heights every metre; in the lower half a bowl every 40 m, 12 m wide, with a rim
// 1.2 m above its floor. `shown` scales all of it.
Terrain ground(double shown) {
  Grid<float> heights(401, 401);
  for (std::int64_t r = 0; r < 401; ++r)
    for (std::int64_t c = 0; c < 401; ++c) {
      const double x = double(c) - 200, y = 200 - double(r);
      const double off = std::hypot(std::remainder(x, 40), std::remainder(y - 20, 40)) / 6;
      const double bowl = y < 0 ? (off < 1 ? 1.2 * (off * off - 0.8) : 0.24 / (off * off * off)) : 0;
      heights(c, r) = static_cast<float>(shown * (bowl + 0.2 * y + 0.3 * std::sin(x / 7)));
    }
  return {std::move(heights), -200, 200, 1, 1};
}

Observation crater(double x, double y, double confidence) {
  Observation o;
  o.type = kTypes.id("crater");
  o.position.xyz << x, y, 0;
  o.confidence = confidence;
  o.features = {{6, 0.1, 1}, {}, {12, 0.1, 1}, {12, 0.1, 1}, {0, 0.1, 1}};
  return o;
}

// The image is certain of most and doubtful about the last of each row.
std::vector<Observation> seen() {
  std::vector<Observation> all;
  for (int i = -4; i <= 4; ++i)
    for (const double row : {20.0, 60.0, 100.0}) {
      all.push_back(crater(40.0 * i, -row, 0.95));
      all.push_back(crater(40.0 * i, row, 0.1));
    }
  all[all.size() - 2].confidence = 0.35;
  all.back().confidence = 0.65;
  return all;
}

TEST(RimShape, IsDepthEvennessAndRaisedFractionOfARim) {
  GroundOutline outline{.centre = {0, -20, 0}, .major = 12, .minor = 12, .orientation = 0};
  const RimShape bowl = measure_rim_shape(ground(1), outline).value();
  EXPECT_NEAR(bowl.depth, 0.09, 0.02);  // 1.2 m of 12, minus the smoothing by cells
  EXPECT_GT(bowl.evenness, 0.8);
  EXPECT_NEAR(bowl.raised, 0.13, 0.04);  // 0.24 m less 0.06 m of ejecta, minus the smoothing by cells
  outline.centre.y() = 60;
  EXPECT_NEAR(measure_rim_shape(ground(1), outline)->depth, 0, 0.02);
  outline.major = outline.minor = 2.5;
  EXPECT_FALSE(measure_rim_shape(ground(1), outline));  // below three cells
  outline.major = outline.minor = 300;
  EXPECT_FALSE(measure_rim_shape(ground(1), outline));  // beyond the heights
}

// A valley is as deep and wide as a crater and open at both ends.
TEST(RimShape, OfAValleyIsNotEven) {
  Grid<float> heights(81, 81);
  for (std::int64_t r = 0; r < 81; ++r)
    for (std::int64_t c = 0; c < 81; ++c) {
      const double off = (double(c) - 40) / 6;
      heights(c, r) = static_cast<float>(off * off < 1 ? 1.2 * (off * off - 1) : 0);
    }
  const Terrain valley(std::move(heights), -40, 40, 1, 1);
  const GroundOutline outline{.centre = {0, 0, 0}, .major = 12, .minor = 12, .orientation = 0};
  const RimShape shape = measure_rim_shape(valley, outline).value();
  EXPECT_GT(shape.depth, 0.04);
  EXPECT_LT(shape.evenness, 0.3);
  EXPECT_LT(crater_log_odds(shape), 0);
}

TEST(CraterLogOdds, GrowWithEachPropertyOfARimUntilTheDepthIsClear) {
  const RimShape rim{.depth = 0.04, .evenness = 0.6, .raised = 0.2};
  const auto changed = [&](double RimShape::*property, double by) {
    RimShape other = rim;
    other.*property += by;
    return crater_log_odds(other) - crater_log_odds(rim);
  };
  EXPECT_GT(changed(&RimShape::depth, 0.01), 0.5);
  EXPECT_GT(changed(&RimShape::evenness, 0.2), 0.5);
  EXPECT_GT(changed(&RimShape::raised, 0.2), 0.5);
  EXPECT_EQ(changed(&RimShape::depth, 0.1), changed(&RimShape::depth, 0.2));
}

// Seeds that no page was tuned on; heights with errors of 0.1 m in cells of 1 m.
TEST(CraterLogOdds, SeparateTrueCratersFromGroundBesideThem) {
  int craters = 0, grounds = 0, right = 0, wrong = 0;
  for (const std::uint64_t seed : {6301, 6302}) {
    testbed::Scenario scenario;
    scenario.ground.width = scenario.ground.height = 500;
    scenario.ground.cell = 0.5;
    scenario.dem = {.cell = 1, .height_sd = 0.1};
    const testbed::Scene scene = testbed::make_scene(scenario.ground, seed);
    const Terrain dem = given_terrain(scenario, scene);
    const auto odds = [&](const Eigen::Vector2d& at, const testbed::TrueCrater& like) {
      GroundOutline outline{.major = like.major, .minor = like.minor, .orientation = like.orientation};
      outline.centre << at, 0;
      const auto shape = measure_rim_shape(dem, outline);
      return shape ? std::optional(crater_log_odds(*shape)) : std::nullopt;
    };
    Random random(seed, "ground beside craters");
    for (const testbed::TrueCrater& crater : scene.craters) {
      if (crater.diameter() < 6 || crater.preserved_fraction() < testbed::kErased) continue;
      if (const auto found = odds(crater.position.head<2>(), crater);
          found && crater.depth > 0.1 * crater.diameter())
        ++craters, right += *found > 0;
      const double turn = random.uniform(0, 2 * std::numbers::pi);
      const Eigen::Vector2d beside =
          crater.position.head<2>() +
          1.5 * crater.diameter() * Eigen::Vector2d(std::cos(turn), std::sin(turn));
      const bool on_another = std::ranges::any_of(scene.craters, [&](const testbed::TrueCrater& other) {
        return (other.position.head<2>() - beside).norm() < 0.75 * other.diameter();
      });
      if (on_another) continue;
      if (const auto found = odds(beside, crater)) ++grounds, wrong += *found > 0;
    }
  }
  RecordProperty("craters", craters), RecordProperty("craters_above_even", right);
  RecordProperty("ground", grounds), RecordProperty("ground_above_even", wrong);
  EXPECT_GE(craters, 50);
  EXPECT_GE(grounds, 100);
  EXPECT_GE(right, 0.9 * craters);
  EXPECT_LE(wrong, 0.05 * grounds);
}

TEST(WeighByRims, HeightsDecideWhatTheImageLeavesInDoubt) {
  std::vector<Observation> all = seen();
  update_crater_confidences(all, kTypes, ground(1), 1);
  EXPECT_GT(all[all.size() - 2].confidence, 0.6);
  EXPECT_LT(all.back().confidence, 0.4);
  EXPECT_GT(all[0].confidence, 0.95);
  EXPECT_LT(all[1].confidence, 0.1);
}

TEST(WeighByRims, HeightsThatShowNoCratersSayNothing) {
  std::vector<Observation> all = seen();
  update_crater_confidences(all, kTypes, ground(0), 1);
  EXPECT_GT(all.back().confidence, 0.55);
  EXPECT_LT(all[all.size() - 2].confidence, 0.45);
}

TEST(WeighByRims, RocksAreLeftAlone) {
  Observation rock = crater(0, -20, 0.4);
  rock.type = kTypes.id("rock");
  rock.features = {{6, 0.1, 1}, {}};
  std::vector<Observation> all{rock};
  update_crater_confidences(all, kTypes, ground(1), 1);
  EXPECT_EQ(all[0].confidence, 0.4);
}

TEST(WeighByRims, PlacesAreInTheMapsUnits) {
  std::vector<Observation> metres = seen(), feet = seen();
  for (Observation& o : feet) o.position.xyz.head<2>() /= 0.3048;
  update_crater_confidences(metres, kTypes, ground(1), 1);
  update_crater_confidences(feet, kTypes, ground(1), 0.3048);
  for (std::size_t i = 0; i < feet.size(); ++i) EXPECT_NEAR(feet[i].confidence, metres[i].confidence, 1e-9);
}

}  // namespace
}  // namespace waymark::test
