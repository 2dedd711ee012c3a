// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/relief_shadows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace waymark::test {
namespace {

using workflows::ReliefShadows;
using workflows::RockRelief;

/// Slow twin: goes along the ray without leaving squares out. It steps two samples where the whole square of
/// 16 is below the ray, one sample elsewhere.
bool is_shadowed_step_by_step(const RockRelief& relief, double elevation, double angle, std::int64_t column,
                              std::int64_t row) {
  const auto is_square_below = [&](std::int64_t u, std::int64_t v, double z) {
    for (std::int64_t y = v >> 4 << 4; y < std::min(relief.rows, ((v >> 4) + 1) << 4); ++y)
      for (std::int64_t x = u >> 4 << 4; x < std::min(relief.columns, ((u >> 4) + 1) << 4); ++x)
        if (!(z > static_cast<double>(relief(x, y)))) return false;
    return true;
  };
  const double start = relief(column, row) + 1e-4;
  for (double t = 1;;) {
    const double z = start + t * (std::tan(elevation) / RockRelief::kSamples);
    const double x = static_cast<double>(column) + t * std::cos(angle);
    const double y = static_cast<double>(row) + t * std::sin(angle);
    if (!(x > -0.5 && y > -0.5 && x < static_cast<double>(relief.columns) - 0.5 &&
          y < static_cast<double>(relief.rows) - 0.5))
      return false;
    const auto u = static_cast<std::int64_t>(x + 0.5), v = static_cast<std::int64_t>(y + 0.5);
    if (is_square_below(u, v, z)) {
      t += 2;
      continue;
    }
    if (static_cast<double>(relief(u, v)) > z) return true;
    t += 1;
  }
}

TEST(ReliefShadows, AreThoseOfTheRayFollowedStepByStep) {
  Random random(5, "reliefs");
  std::int64_t shadowed = 0, compared = 0;
  for (int round = 0; round < 12; ++round) {
    RockRelief relief(8, 5);
    for (int n = 0; n < 12; ++n) {  // blocks on level ground
      const double x = random.uniform(0, static_cast<double>(relief.columns - 20));
      const double y = random.uniform(0, static_cast<double>(relief.rows - 20));
      const auto height = static_cast<float>(random.uniform(0.2, 8));
      for (std::int64_t v = 0; v < 20; ++v)
        for (std::int64_t u = 0; u < 20; ++u)
          relief(static_cast<std::int64_t>(x) + u, static_cast<std::int64_t>(y) + v) = height;
    }
    const double elevation = random.uniform(0.1, 1.2), angle = random.uniform(0, 2 * std::numbers::pi);
    const ReliefShadows shadows(relief, elevation, angle);
    for (int n = 0; n < 400; ++n) {
      const auto u = static_cast<std::int64_t>(random.uniform(0, static_cast<double>(relief.columns)));
      const auto v = static_cast<std::int64_t>(random.uniform(0, static_cast<double>(relief.rows)));
      const bool expected = is_shadowed_step_by_step(relief, elevation, angle, u, v);
      EXPECT_EQ(shadows.is_shadowed(u, v), expected) << "round " << round << ", sample " << u << ", " << v;
      shadowed += expected, ++compared;
    }
  }
  EXPECT_GT(shadowed, compared / 20);
  EXPECT_LT(shadowed, compared / 2);
}

/// The sun 45 degrees high behind a wall of two samples, which the steps cannot miss: its shadow is as long
/// as it is high.
TEST(ReliefShadows, OfAWallAreAsLongAsItIsHigh) {
  RockRelief relief(40, 1);
  const std::int64_t wall = relief.columns / 2, row = relief.rows / 2;
  for (std::int64_t v = 0; v < relief.rows; ++v) relief(wall, v) = relief(wall + 1, v) = 5;
  const ReliefShadows shadows(relief, std::numbers::pi / 4, 0);
  for (std::int64_t u = 1; u < wall; ++u)
    EXPECT_EQ(shadows.is_shadowed(u, row), wall - u < 5 * RockRelief::kSamples) << u;
  EXPECT_FALSE(shadows.is_shadowed(wall, row));
  EXPECT_FALSE(shadows.is_shadowed(wall + 2, row));
}

}  // namespace
}  // namespace waymark::test
