// SPDX-License-Identifier: Apache-2.0
#include "planning/sun_horizon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
namespace waymark::test {
using namespace planning;
namespace {

HeightWindow flat(std::int64_t columns, std::int64_t rows) {
  return HeightWindow(columns, rows, 0);
}

TEST(SunHorizon, AWallEastOfACellRisesByItsTangent) {
  const HorizonRay ray{.azimuth = 90, .reach = 30, .cell_x = 2, .cell_y = 2};
  const HorizonMargin m = horizon_margin(ray);
  EXPECT_GE(m.east, 15);
  EXPECT_LE(m.west, 1);
  HeightWindow heights = flat(1 + m.west + m.east, 1 + m.north + m.south);
  const Window inner{m.west, m.north, 1, 1};
  EXPECT_NEAR(sun_horizon(heights, inner, ray)(0, 0), 0, 1e-6);
  for (std::int64_t r = 0; r < heights.rows(); ++r) heights(m.west + 5, r) = 10;  // 10 m away
  EXPECT_NEAR(sun_horizon(heights, inner, ray)(0, 0), 45, 1e-5);
  const HorizonRay west{.azimuth = 270, .reach = 2, .cell_x = 2, .cell_y = 2};
  EXPECT_NEAR(sun_horizon(heights, inner, west)(0, 0), 0, 1e-6);
}

TEST(SunHorizon, CurvatureLowersWhatIsFar) {
  const HorizonRay ray{.azimuth = 0, .reach = 3000, .cell_x = 100, .cell_y = 100, .body_radius = 1737400};
  const HorizonMargin m = horizon_margin(ray);
  HeightWindow heights = flat(1 + m.west + m.east, 1 + m.north + m.south);
  heights(m.west, m.north - 30) = 50;
  const double drop = 3000.0 * 3000 / (2 * 1737400);
  EXPECT_NEAR(sun_horizon(heights, {m.west, m.north, 1, 1}, ray)(0, 0),
              std::atan((50 - drop) / 3000) * 180 / std::numbers::pi, 1e-5);
}

TEST(SunHorizon, StoppingEarlyChangesNothing) {
  Random random(5);
  for (const double azimuth : {0.0, 37.0, 90.0, 123.0, 180.0, 251.0, 270.0, 359.0}) {
    const HorizonRay ray{.azimuth = azimuth, .reach = 25, .cell_x = 1, .cell_y = 1.5};
    const HorizonMargin m = horizon_margin(ray);
    HeightWindow heights = flat(9 + m.west + m.east, 7 + m.north + m.south);
    for (double& h : heights.cells()) h = random.bernoulli(0.1) ? kNoHeight : random.uniform(0, 4);
    const Window inner{m.west, m.north, 9, 7};
    const Grid<float> fast = sun_horizon(heights, inner, ray),
                      slow = sun_horizon_directly(heights, inner, ray);
    for (std::size_t i = 0; i < fast.cells().size(); ++i) {
      ASSERT_EQ(std::isnan(fast.cells()[i]), std::isnan(slow.cells()[i]));
      if (!std::isnan(slow.cells()[i])) {
        ASSERT_EQ(fast.cells()[i], slow.cells()[i]) << azimuth;
      }
    }
  }
}

}  // namespace
}  // namespace waymark::test
