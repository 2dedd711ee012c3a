// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/shaded_by_relief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace waymark::test {
using namespace pipeline;
namespace {

const Eigen::Vector3d kEast30(std::cos(M_PI / 6), 0, std::sin(M_PI / 6));  // sun in the east, 30 degrees high

Terrain terrain(const std::function<double(double, double)>& height) {
  Grid<float> heights(161, 161);
  for (std::int64_t r = 0; r < 161; ++r)
    for (std::int64_t c = 0; c < 161; ++c)
      heights(c, r) = static_cast<float>(height(double(c) - 80, 80 - double(r)));
  return Terrain(std::move(heights), -80, 80, 1, 1);
}

// Half ellipsoid about the origin.
double boulder(double x, double y, double radius, double height) {
  return height * std::sqrt(std::max(0.0, 1 - (x * x + y * y) / (radius * radius)));
}

bool explained(const Terrain& ground, const SupposedRock& rock) {
  return explained_by_relief(ground, std::span(&rock, 1), kEast30).front() != 0;
}

TEST(ShadedByRelief, LightOfAnEvenSlopeIsThatAround) {
  const Terrain slope = terrain([](double x, double y) { return 0.3 * x + 0.1 * y; });
  const auto seen = measure_relief(slope, {{0, 0}, 3, 2}, kEast30);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->light, 1, 1e-6);
  EXPECT_LT(seen->stands_out, 0);
}

TEST(ShadedByRelief, AScarpOfTheRocksSizeIsNoRock) {
  // High ground from x = 2 on, which shades 5.2 m; a rock as wide as that is supposed at its foot.
  const Terrain scarp = terrain([](double x, double y) { return x >= 2 && std::abs(y) < 12 ? 3 : 0; });
  EXPECT_TRUE(explained(scarp, {{2, 0}, 3, 3}));
  EXPECT_FALSE(explained(scarp, {{-40, 0}, 3, 3}));
  EXPECT_FALSE(explained(scarp, {{2, 0}, 0.9, 0.9})) << "smaller than two cells";
}

TEST(ShadedByRelief, ABodyInTheHeightsIsARock) {
  for (const double radius : {2.0, 3.0, 5.0, 8.0})
    for (const double slope : {0.0, 0.2}) {
      const Terrain ground =
          terrain([&](double x, double y) { return slope * y + boulder(x, y, radius, radius); });
      EXPECT_FALSE(explained(ground, {{0, 0}, radius, radius})) << radius << " m on a slope of " << slope;
      EXPECT_LT(measure_relief(ground, {{0, 0}, radius, radius}, kEast30)->light, 0.7);
    }
}

TEST(ShadedByRelief, UnknownHeightsExplainNothing) {
  const Terrain gap = terrain([](double x, double) { return x < -3 ? std::nan("") : x >= 2 ? 3.0 : 0.0; });
  EXPECT_FALSE(measure_relief(gap, {{2, 0}, 3, 3}, kEast30));
  EXPECT_FALSE(explained(gap, {{2, 0}, 3, 3}));
}

TEST(ShadedByRelief, ErrorsOfHeightsRefuteNoRocks) {
  std::mt19937 random(7);
  std::normal_distribution<double> error(0, 0.6);
  const Terrain noisy = terrain([&](double, double) { return error(random); });
  std::vector<SupposedRock> rocks;
  for (int x = -50; x <= 50; x += 10)
    for (int y = -50; y <= 50; y += 10) rocks.push_back({{x, y}, 1.2, 1});
  const auto count = [&](const ReliefRules& rules) {
    return std::ranges::count(explained_by_relief(noisy, rocks, kEast30, rules), 1);
  };
  EXPECT_LE(count({}), 3);
  EXPECT_GT(count({.drop_sds = 0}), 10) << "what the spread of the light prevents";
}

}  // namespace
}  // namespace waymark::test
