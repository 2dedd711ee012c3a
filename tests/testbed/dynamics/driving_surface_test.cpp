// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/driving_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/testbed/dynamics/made_ground.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

std::vector<RockSolid> many_rocks(const Terrain& terrain, int count) {
  Random random(7);
  std::vector<RockSolid> rocks;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-20, 20), y = random.uniform(-20, 20), size = random.uniform(0.1, 1);
    rocks.push_back(rock_at({x, y, *terrain.height(x, y)}, size, random.uniform(0.05, 0.6),
                            random.bernoulli(0.5) ? RockShape::ellipsoid : RockShape::cylinder));
  }
  return rocks;
}

TEST(DrivingSurface, IsThatOfAllRocksAndTheTerrain) {
  const Terrain terrain = plane(0.1, -0.05);
  const std::vector<RockSolid> rocks = many_rocks(terrain, 400);
  const DrivingSurface surface(terrain, rocks);
  Random random(8);
  int on_rock = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d at(random.uniform(-24, 24), random.uniform(-24, 24));
    double height = *terrain.height(at.x(), at.y());
    for (const RockSolid& rock : rocks)
      if (const auto hit = intersect(rock, {at.x(), at.y(), 50}, -Eigen::Vector3d::UnitZ()))
        height = std::max(height, 50 - hit->t);
    const auto point = surface.at(at);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->height, height, 1e-9);
    on_rock += point->on_rock ? 1 : 0;
  }
  EXPECT_GT(on_rock, 100);
  EXPECT_FALSE(surface.at({80, 0}));
}

// The slow twin lowers a dense disc onto the surface.
TEST(DrivingSurface, AWheelRestsOnWhatItsRimTouchesFirst) {
  const Terrain terrain = plane(0, 0);
  const std::vector<RockSolid> rocks = many_rocks(terrain, 400);
  const DrivingSurface surface(terrain, rocks);
  constexpr double kRadius = 0.26, kWidth = 0.3;
  Random random(9);
  double largest = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d centre(random.uniform(-20, 20), random.uniform(-20, 20));
    const double yaw = random.uniform(-3, 3);
    const Eigen::Vector2d heading(std::cos(yaw), std::sin(yaw)), across(-heading.y(), heading.x());
    double lowest = 0;
    for (int along = -60; along <= 60; ++along)
      for (int sideways = -10; sideways <= 10; ++sideways) {
        const double d = kRadius * std::sin(along / 60.0 * 1.4);
        const Eigen::Vector2d at = centre + d * heading + sideways / 10.0 * kWidth / 2 * across;
        lowest = std::max(lowest, surface.at(at)->height + std::sqrt(kRadius * kRadius - d * d) - kRadius);
      }
    const auto touch = surface.lower_wheel(centre, heading, kRadius, kWidth);
    ASSERT_TRUE(touch);
    EXPECT_LT(touch->height, lowest + 1e-6);
    largest = std::max(largest, lowest - touch->height);
    EXPECT_NEAR(touch->normal.norm(), 1, 1e-9);
  }
  EXPECT_LT(largest, 0.11) << "edges of cylinders lie between two samples of the rim, 7 cm apart";
}

TEST(DrivingSurface, OnASlopeTheRimTouchesBesideItsLowestPoint) {
  const Terrain terrain = plane(0.5, 0);
  const DrivingSurface surface(terrain, {});
  const auto touch = surface.lower_wheel({0.3, 0.2}, {1, 0}, 0.4, 0.2);
  ASSERT_TRUE(touch);
  // The centre is one radius from the plane.
  EXPECT_NEAR((touch->height + 0.4 - 0.15) / std::hypot(1, 0.5), 0.4, 1e-6);
}

}  // namespace
}  // namespace waymark::test
