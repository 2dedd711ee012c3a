// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/rim_closure.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(ClosedRim, IsWhatStandsAboveTheFloorAllRound) {
  GroundOutline outline{.centre = {0, -20, 0}, .major = 12, .minor = 12, .orientation = 0};
  EXPECT_NEAR(rim_closure(ground(1), outline).value(), 0.09,
              0.02);  // 1.2 m of 12, minus the smoothing by cells
  outline.centre.y() = 60;
  EXPECT_NEAR(rim_closure(ground(1), outline).value(), 0, 0.015);
  outline.major = outline.minor = 2.5;
  EXPECT_FALSE(rim_closure(ground(1), outline));  // below three cells
  outline.major = outline.minor = 300;
  EXPECT_FALSE(rim_closure(ground(1), outline));  // beyond the heights
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
