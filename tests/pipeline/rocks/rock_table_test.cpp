// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/rock_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/rocks/synthetic_rock.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kPi = std::numbers::pi;

ShadowMap map_of(const Grid<float>& alpha) {
  ShadowMap map;
  map.alpha = alpha;
  map.smooth = smooth_alpha(alpha);
  return map;
}

ShadowShape shape_of(const SyntheticRock& rock, std::int64_t size) {
  const ShadowMap map = map_of(render_rock_shadow(rock, size, size));
  const auto segments = find_segments(map, {.grow = 0.05F, .seed = 0.1F});
  EXPECT_EQ(segments.size(), 1U);
  return segments.empty() ? ShadowShape{} : measure_shadow(map, segments[0], LightFrame::of(rock.sun_angle));
}

// The shadow of a half ellipsoid is the half ellipse of half axes r and d = sqrt(r^2 + reach^2), less the
// half ellipse of half axes r and r^2 / d that is lit.
TEST(DrawRock, ShadowHasTheAreaOfTheClosedForm) {
  const SyntheticRock rock{.radius = 8, .reach = 10, .elevation = {0.7}, .x = 60, .y = 50, .blur = 0.3};
  const Grid<float> picture = render_rock_shadow(rock, 100, 100);
  double full = 0;
  for (const float alpha : picture.cells()) full += alpha > 0.999F ? 1 : 0;
  const double d = std::hypot(8, 10);
  const double ground = kPi / 2 * 8 * d - kPi / 2 * 8 * 8;  // beyond the outline
  const double whole = kPi / 2 * 8 * (d - 64 / d);
  EXPECT_GT(full, ground - 40);  // the blurred edge of some 60 px is not quite dark
  EXPECT_LT(full, whole);
}

TEST(DrawRock, LitFaceIsBrighterThanTheGround) {
  const SyntheticRock rock{.radius = 8, .reach = 10, .elevation = {0.6}, .sun_angle = {0}, .x = 60, .y = 50};
  const Grid<float> picture = render_rock_shadow(rock, 100, 100);
  EXPECT_LT(picture(65, 50), -0.2F);
  EXPECT_GT(picture(50, 50), 0.99F);
  EXPECT_NEAR(picture(20, 50), 0, 1e-6);
}

TEST(RockTable, FindsTheRocksItIsMadeOf) {
  const Radians elevation = to_radians(Degrees{40});
  const RockTable table(elevation, true, 0.6);
  for (const double radius : {1.5, 2.5, 4.0, 7.0})
    for (const double height : {0.35, 0.5, 0.7}) {  // of the diameter
      const double reach = 2 * radius * height / std::tan(elevation.value);
      const SyntheticRock rock{.radius = radius,
                               .reach = reach,
                               .elevation = elevation,
                               .sun_angle = {2.0},
                               .x = 40.3,
                               .y = 39.8,
                               .blur = 0.6};
      const ShadowShape shape = shape_of(rock, 80);
      const RockSize size = table.estimate_size(shape, 0.01, 0.02);
      // The table lies between ellipsoids and cylinders: a tenth either way.
      EXPECT_NEAR(size.radius / radius, 1, 0.10) << radius << " " << height;
      EXPECT_NEAR(size.reach / reach, 1, 0.16) << radius << " " << height;
      const LightFrame light = LightFrame::of(rock.sun_angle);
      EXPECT_NEAR(shape.x - light.ux * size.offset, 40.3, 0.18 * radius + 0.1);
      EXPECT_NEAR(shape.y - light.uy * size.offset, 39.8, 0.18 * radius + 0.1);
    }
}

TEST(RockTable, LargerRocksThanItsLargestKeepProportion) {
  const RockTable table(to_radians(Degrees{45}), true, 0.6);
  const ShadowShape small =
      shape_of({.radius = 9, .reach = 9, .elevation = {kPi / 4}, .x = 60, .y = 60}, 120);
  const ShadowShape large =
      shape_of({.radius = 27, .reach = 27, .elevation = {kPi / 4}, .x = 120, .y = 120}, 240);
  EXPECT_NEAR(table.estimate_size(large, 0, 0).radius / table.estimate_size(small, 0, 0).radius, 3, 0.25);
}

TEST(RockTable, NoiseAndTextureWidenTheDeviations) {
  const RockTable table(to_radians(Degrees{45}), true, 0.6);
  const ShadowShape shape = shape_of({.radius = 3, .reach = 3, .elevation = {kPi / 4}, .x = 30, .y = 30}, 60);
  const RockSize clear = table.estimate_size(shape, 0.01, 0.01), noisy = table.estimate_size(shape, 0.2, 0.1);
  EXPECT_GT(noisy.radius_sd, 1.3 * clear.radius_sd);
  EXPECT_GT(noisy.reach_sd, 1.2 * clear.reach_sd);
}

}  // namespace
}  // namespace waymark::test
