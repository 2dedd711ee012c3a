// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/ground_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <tuple>

#include "core/random.hpp"
#include "testbed/forest/forest_scan.hpp"
#include "testbed/scene.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

struct SyntheticCloud {
  testbed::Scene scene;
  std::vector<Eigen::Vector3d> returns;
};

SyntheticCloud cloud(double density, double conifers, double rms, std::uint64_t seed) {
  testbed::ForestModel law;
  law.width = law.height = 120;
  law.density = density;
  law.conifers = conifers;
  law.pulses = 8;
  testbed::SiteModel ground;
  ground.width = ground.height = 200;
  ground.cell = 1;
  ground.relief = {.rms = rms, .longest = 120, .roughness = 0.5};
  ground.craters.density = 0;
  ground.craters.clusters = 0;
  ground.rocks.k = 0;
  ground.dunes.cover = 0;
  SyntheticCloud made{testbed::make_scene(ground, seed), {}};
  const testbed::SyntheticForest forest = testbed::plant_forest(law, made.scene.terrain, 0, 0, seed);
  testbed::scan_forest(law, forest, made.scene.terrain, 0, 0, seed,
                       [&](std::span<const testbed::LaserReturn> row) {
                         for (const testbed::LaserReturn& r : row) made.returns.emplace_back(r.x, r.y, r.z);
                       });
  return made;
}

TEST(GroundReturns, LieOnTheGroundUnderMadeForests) {
  struct {
    double density, conifers, rms;
  } cases[] = {{300, 1, 1}, {500, 0.5, 5}, {1000, 0, 5}, {800, 0.7, 12}};
  for (const auto& [density, conifers, rms] : cases) {
    const SyntheticCloud made = cloud(density, conifers, rms, 7);
    const std::vector<Eigen::Vector3d> ground = ground_returns(made.returns);
    double squares = 0, off_by_a_metre = 0;
    for (const Eigen::Vector3d& p : ground) {
      const double off = p.z() - made.scene.terrain.height(p.x(), p.y()).value_or(p.z());
      squares += off * off;
      off_by_a_metre += std::abs(off) > 1;
    }
    const double count = static_cast<double>(ground.size());
    std::printf(
        "%4.0f stems/ha, %.0f %% conifers, relief %4.1f m: %.0f returns, RMS %.2f m, %.2f %% off by 1 m\n",
        density, 100 * conifers, rms, count, std::sqrt(squares / count), 100 * off_by_a_metre / count);
    EXPECT_GT(count, 0.3 * 120 * 120);
    EXPECT_LT(std::sqrt(squares / count), 0.3);
    EXPECT_LT(off_by_a_metre, 0.02 * count);
  }
}

TEST(GroundReturns, DoNotDependOnTheOrder) {
  SyntheticCloud made = cloud(500, 0.5, 5, 3);
  const auto sorted = [](std::vector<Eigen::Vector3d> points) {
    std::ranges::sort(points, [](const auto& a, const auto& b) {
      return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
    });
    return points;
  };
  const auto first = sorted(ground_returns(made.returns));
  std::ranges::reverse(made.returns);
  EXPECT_EQ(first, sorted(ground_returns(made.returns)));
}

TEST(GroundReturns, LeaveEchoesFromBelowOut) {
  std::vector<Eigen::Vector3d> returns;
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform(0, 100), y = random.uniform(0, 100);
    returns.emplace_back(x, y, 0.2 * x + random.normal(0, 0.03));
  }
  for (int i = 0; i < 9; ++i) returns.emplace_back(20 + 30 * (i % 3), 20 + 30 * (i / 3), -20);
  const auto ground = ground_returns(returns);
  ASSERT_GT(ground.size(), 5000u);
  for (const Eigen::Vector3d& p : ground) EXPECT_NEAR(p.z(), 0.2 * p.x(), 0.5);
}

TEST(GroundReturns, OfTooFewAreNone) {
  EXPECT_TRUE(ground_returns({}).empty());
  const std::vector<Eigen::Vector3d> three{{0, 0, 1}, {30, 0, 1}, {0, 30, 1}};
  EXPECT_TRUE(ground_returns(three).empty());
}

}  // namespace
}  // namespace waymark::test
