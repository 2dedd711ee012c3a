// SPDX-License-Identifier: Apache-2.0
// The direction of the light where the sun is not known, on views that nothing was fitted to.
#include "pipeline/rocks/rock_sun_angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "pipeline/light_in_image.hpp"
#include "tests/pipeline/rocks/foliage.hpp"
#include "tests/support/angles.hpp"
#include "tests/support/seed_offset.hpp"
#include "workflows/training/rock_views.hpp"
namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

TEST(RockSunAngle, IsTheSunsOrUnknownOnUnseenViews) {
  int right = 0, unknown = 0, wrong = 0;
  for (int k = 1020; k < 1040; ++k) {
    const SyntheticView view = synthetic_view(k + static_cast<int>(seed_offset()));
    const Pixels& pixels = view.image.pixels;
    const auto seen = estimate_rock_sun_angle(pixels, crater_sun_angle(pixels));
    const double off = seen ? std::abs(std::remainder(seen->angle.value - view.sun_angle, kFullTurn)) : 0;
    ++(!seen ? unknown : off < 0.35 ? right : wrong);
    std::printf("view %d, elevation %.0f deg: %s %.0f deg\n", k, to_degrees(view.elevation).value,
                seen ? "off by" : "unknown", to_degrees(Radians{off}).value);
  }
  std::printf("right %d, unknown %d, wrong %d\n", right, unknown, wrong);
  EXPECT_LE(wrong, 1);
  EXPECT_GE(right, 14);
}

TEST(RockSunAngle, LeavesHaveNone) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Pixels leaves = foliage(seed);
    EXPECT_FALSE(estimate_rock_sun_angle(leaves, crater_sun_angle(leaves))) << "seed " << seed;
  }
}

TEST(RockSunAngle, ImagesWithoutContrastHaveNone) {
  EXPECT_FALSE(estimate_rock_sun_angle(Pixels()));
  EXPECT_FALSE(estimate_rock_sun_angle(Pixels(1, 1, 9)));
  EXPECT_FALSE(estimate_rock_sun_angle(Pixels(100, 100, 0)));
  EXPECT_FALSE(estimate_rock_sun_angle(Pixels(64, 64, std::nanf(""))));
}

// Craters decide where hollows and rocks contradict each other; a few of them do not outweigh deep shadows.
TEST(RockSunAngle, CratersChooseTheSide) {
  const SyntheticView view = synthetic_view(1020);
  SunAngle craters{{view.sun_angle}, {0.05}, 60};
  const auto seen = estimate_rock_sun_angle(view.image.pixels, craters);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->angle.value, craters.angle.value);
  craters.angle.value += kFullTurn / 4;  // across the axis of the spots: no evidence
  const auto other = estimate_rock_sun_angle(view.image.pixels, craters);
  EXPECT_TRUE(!other || std::abs(std::remainder(other->angle.value - craters.angle.value, kFullTurn)) > 1);
}

}  // namespace
}  // namespace waymark::test
