// SPDX-License-Identifier: Apache-2.0
#include "geo/terrain.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/random.hpp"

namespace waymark::test {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Ray<GridFrame> ray_to(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {{from}, {(to - from).normalized()}};
}

Terrain rough(std::uint64_t seed, std::int64_t columns, std::int64_t rows, double step_x = 1,
              double step_y = 1) {
  Random random(seed);
  Grid<float> heights(columns, rows);
  for (float& h : heights.cells()) h = static_cast<float>(random.uniform(0, 4));
  return Terrain(std::move(heights), 100, 200, step_x, step_y);
}

Terrain flat(float height, std::int64_t size = 5) {
  return Terrain(Grid<float>(size, size, height), 0, double(size - 1), 1, 1);
}

// The slow twin: small steps until the ray is below the ground, then bisection.
std::optional<double> march(const Terrain& terrain, const Ray<GridFrame>& ray, double longest) {
  const auto above = [&](double t) -> std::optional<double> {
    const Eigen::Vector3d p = ray.origin.xyz + t * ray.direction.unit;
    const auto h = terrain.height(p.x(), p.y());
    if (!h) return std::nullopt;
    return p.z() - *h;
  };
  constexpr double kStep = 2e-3;
  for (double t = 0; t < longest; t += kStep) {
    const auto here = above(t), next = above(t + kStep);
    if (!here || !next || *here <= 0 || *next > 0) continue;
    double low = t, high = t + kStep;
    for (int i = 0; i < 60; ++i) (above((low + high) / 2).value_or(1) > 0 ? low : high) = (low + high) / 2;
    return high;
  }
  return std::nullopt;
}

TEST(Terrain, RaysIntersectWhereMarchingDoes) {
  int met = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, "rays");
    const Terrain terrain =
        rough(seed, 3 + std::int64_t(random.uniform_index(12)), 2 + std::int64_t(random.uniform_index(12)),
              random.uniform(0.5, 2), random.uniform(0.5, 2));
    const double width = terrain.step_x() * double(terrain.heights().columns() - 1);
    const double height = terrain.step_y() * double(terrain.heights().rows() - 1);
    const auto spot = [&](double z) {
      return Eigen::Vector3d(100 + random.uniform(0, width), 200 - random.uniform(0, height), z);
    };
    const Eigen::Vector3d from = spot(random.uniform(4.2, 9)), to = spot(random.uniform(-2, 5));
    const Ray<GridFrame> ray = ray_to(from, to);
    const RayHit hit = terrain.cast(ray);
    const auto expected = march(terrain, ray, 60);
    ASSERT_EQ(hit.end == RayEnd::ground, expected.has_value()) << "seed " << seed;
    if (!expected) continue;
    ++met;
    // A step of 2 mm may skip a grazed crest; the twin's hit is then farther.
    EXPECT_LE(hit.range, *expected + 1e-6) << "seed " << seed;
    EXPECT_LT(*expected - hit.range, std::abs(hit.range - *expected) > 1e-5 ? 3 : 1e-4) << "seed " << seed;
    EXPECT_NEAR(*terrain.height(hit.point.xyz.x(), hit.point.xyz.y()), hit.point.xyz.z(), 1e-5)
        << "seed " << seed;
  }
  EXPECT_GT(met, 200);
}

TEST(Terrain, IsPreciseFarFromTheOrigin) {
  Random random(3);
  Grid<float> heights(64, 64);
  for (float& h : heights.cells()) h = static_cast<float>(-2500 + random.uniform(0, 30));
  const Terrain terrain(std::move(heights), 4.3e6, 5.1e6, 10, 10);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d to(4.3e6 + random.uniform(100, 500), 5.1e6 - random.uniform(100, 500), -2500);
    const RayHit hit = terrain.cast(ray_to({4.3e6 + 200, 5.1e6 - 300, 4e5}, to));
    ASSERT_EQ(hit.end, RayEnd::ground);
    EXPECT_NEAR(*terrain.height(hit.point.xyz.x(), hit.point.xyz.y()), hit.point.xyz.z(), 1e-5);
  }
}

TEST(Terrain, HeightIsBilinearAndEndsAtTheEdge) {
  Grid<float> heights(2, 2);
  heights(0, 0) = 1, heights(1, 0) = 3, heights(0, 1) = 5, heights(1, 1) = 11;
  const Terrain terrain(heights, 10, 20, 2, 4);
  EXPECT_DOUBLE_EQ(*terrain.height(10, 20), 1);
  EXPECT_DOUBLE_EQ(*terrain.height(12, 16), 11);
  EXPECT_DOUBLE_EQ(*terrain.height(11, 18), 5);  // the mean of the four
  EXPECT_FALSE(terrain.height(12.001, 18));
  EXPECT_FALSE(terrain.height(std::nan(""), 18));
  EXPECT_DOUBLE_EQ(terrain.min_height(), 1);
  EXPECT_DOUBLE_EQ(terrain.max_height(), 11);
}

TEST(Terrain, NormalTiltsDownhill) {
  Grid<float> heights(3, 3);
  for (std::int64_t r = 0; r < 3; ++r)
    for (std::int64_t c = 0; c < 3; ++c) heights(c, r) = static_cast<float>(c - 2 * r);  // up east, up north
  const Terrain terrain(heights, 0, 0, 1, 1);
  const Eigen::Vector3d expected = Eigen::Vector3d(-1, -2, 1).normalized();
  EXPECT_NEAR((*terrain.normal(0.5, -0.5) - expected).norm(), 0, 1e-12);
}

TEST(Terrain, ReportsHowARayEnds) {
  const Terrain terrain = flat(10);
  EXPECT_EQ(terrain.cast(ray_to({2, 2, 50}, {2, 2, 0})).end, RayEnd::ground);
  EXPECT_NEAR(terrain.cast(ray_to({2, 2, 50}, {2, 2, 0})).range, 40, 1e-12);
  EXPECT_EQ(terrain.cast(ray_to({2, 2, 50}, {2, 2, 60})).end, RayEnd::sky);
  EXPECT_EQ(terrain.cast(ray_to({2, 2, 50}, {20, 2, 45})).end, RayEnd::sky);
  EXPECT_EQ(terrain.cast(ray_to({2, 2, 5}, {2, 2, 60})).end, RayEnd::underground);
  EXPECT_EQ(terrain.cast(ray_to({-5, 2, 5}, {9, 2, 5})).end, RayEnd::underground);  // enters through the side
  EXPECT_EQ(terrain.cast(ray_to({-5, 2, 50}, {-5, 2, 0})).end, RayEnd::sky);        // beside the terrain
  EXPECT_EQ(terrain.cast(ray_to({2, 2, 10}, {3, 2, 12})).end, RayEnd::sky);         // off the ground
  EXPECT_EQ(terrain.cast(ray_to({2, 2, 10}, {3, 2, 8})).end, RayEnd::ground);       // into it at once
}

TEST(Terrain, UnknownTerrainStopsRaysThatItCouldStop) {
  Grid<float> heights(9, 9, 0.0F);
  heights(4, 4) = kUnknown;
  heights(0, 0) = 5;  // the maximum: unknown terrain may be as high
  const Terrain terrain(heights, 0, 8, 1, 1);
  EXPECT_FALSE(terrain.height(4.5, 4.5));
  EXPECT_EQ(terrain.cast(ray_to({4.2, 4.2, 50}, {4.2, 4.2, 0})).end, RayEnd::no_data);
  EXPECT_EQ(terrain.cast(ray_to({0.5, 4.2, 6}, {7.5, 4.2, 1})).end, RayEnd::no_data);
  EXPECT_EQ(terrain.cast(ray_to({0.5, 4.2, 60}, {7.5, 4.2, -10})).end, RayEnd::ground);  // passes far above
  // Unknown terrain casts no shadow.
  EXPECT_FALSE(terrain.in_shadow({{2, 4.2, 0}}, {Eigen::Vector3d(1, 0, 0.2).normalized()}));
  const Terrain nothing(Grid<float>(4, 4, kUnknown), 0, 0, 1, 1);
  EXPECT_TRUE(std::isnan(nothing.min_height()));
  EXPECT_EQ(nothing.cast(ray_to({1, -1, 50}, {1, -1, 0})).end, RayEnd::no_data);
}

TEST(Terrain, AWallCastsItsShadow) {
  Grid<float> heights(21, 5, 0.0F);
  for (std::int64_t r = 0; r < 5; ++r) heights(15, r) = 4;  // a wall along the line x = 15
  const Terrain terrain(heights, 0, 4, 1, 1);
  const Direction<GridFrame> sun{Eigen::Vector3d(1, 0, 0.5).normalized()};  // its shadow is 8 m long
  EXPECT_TRUE(terrain.in_shadow({{8, 2, 0}}, sun));
  EXPECT_FALSE(terrain.in_shadow({{6.5, 2, 0}}, sun));
  EXPECT_FALSE(terrain.in_shadow({{18, 2, 0}}, sun));
  EXPECT_FALSE(terrain.in_shadow({{15, 2, 4}}, sun));
}

TEST(Terrain, ReachesASegmentWhereItsHeightsDo) {
  int reached = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Terrain terrain = rough(seed, 33, 33);
    Random random(seed, "segments");
    for (int i = 0; i < 50; ++i) {
      const auto point = [&] {
        return Eigen::Vector3d(random.uniform(95, 137), random.uniform(163, 205), random.uniform(0, 9));
      };
      const Eigen::Vector3d a = point(), b = point();
      double lowest = 1e9;  // of the segment above the terrain, by samples
      for (int k = 0; k <= 2000; ++k) {
        const Eigen::Vector3d at = a + (b - a) * k / 2000.0;
        if (const auto ground = terrain.height(at.x(), at.y())) lowest = std::min(lowest, at.z() - *ground);
      }
      if (std::abs(lowest) < 0.05) continue;  // grazing: between two samples the terrain may be higher
      reached += lowest < 0;
      EXPECT_EQ(terrain.reaches({a}, {b}), lowest < 0) << seed << ' ' << i << ' ' << lowest;
    }
  }
  EXPECT_GT(reached, 100);
}

TEST(Terrain, ARayAlongACellBorderIsNotLost) {
  const Terrain terrain = rough(5, 33, 33);
  for (int i = 0; i <= 32; ++i) {
    const RayHit down = terrain.cast(ray_to({100.0 + i, 200 - 16, 50}, {100.0 + i, 200 - 16, 0}));
    ASSERT_EQ(down.end, RayEnd::ground) << i;
    EXPECT_NEAR(down.point.xyz.z(), double(terrain.heights()(i, 16)), 1e-9) << i;
    const RayHit along = terrain.cast(ray_to({100.0 + i, 200, 6}, {100.0 + i, 168, 1}));
    EXPECT_EQ(along.end, RayEnd::ground) << i;
  }
}

TEST(Terrain, RejectsInvalidGrids) {
  try {
    Terrain(Grid<float>(1, 5), 0, 0, 1, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a terrain needs at least 2 x 2 heights\n  1 x 5 given");
  }
  EXPECT_THROW(Terrain(Grid<float>(3, 3), 0, 0, 0, 1), Error);
  EXPECT_THROW(Terrain(Grid<float>(3, 3), 0, 0, 1, std::nan("")), Error);
}

}  // namespace
}  // namespace waymark::test
