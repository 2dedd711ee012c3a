// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/sun_angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kPi = std::numbers::pi;

// Rocks as a bright and a dark Gaussian spot side by side, on noise.
Pixels spots(double sun_angle, int count, double noise) {
  Pixels image(200, 200, 100);
  Random random(3);
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(10, 190), y = random.uniform(10, 190), size = random.uniform(1, 3);
    for (std::int64_t v = 0; v < 200; ++v)
      for (std::int64_t u = 0; u < 200; ++u) {
        const double dx = static_cast<double>(u) - x, dy = static_cast<double>(v) - y;
        const double t = dx * std::cos(sun_angle) + dy * std::sin(sun_angle), q = dx * dx + dy * dy;
        const auto spot = [&](double at) {
          return std::exp(-0.5 * (q - 2 * t * at + at * at) / (size * size));
        };
        image(u, v) += static_cast<float>(30 * spot(size) - 70 * spot(-size));
      }
  }
  for (float& value : image.cells()) value += static_cast<float>(random.normal(0, noise));
  return image;
}

TEST(EstimateSunAngle, FindsEveryDirection) {
  for (int k = 0; k < 12; ++k) {
    const double truth = k * kPi / 6 - 3;
    const auto found = estimate_sun_angle(spots(truth, 25, 2));
    ASSERT_TRUE(found) << truth;
    EXPECT_LT(std::abs(std::remainder(found->angle.value - truth, 2 * kPi)), 0.12) << truth;
    EXPECT_GE(found->shadows, 10);
    EXPECT_GT(found->sd.value, 0);
  }
}

TEST(EstimateSunAngle, DoesNotDependOnBrightnessAndContrast) {
  Pixels image = spots(1, 25, 2);
  const double before = estimate_sun_angle(image)->angle.value;
  for (float& value : image.cells()) value = 7 + 20 * value;
  EXPECT_NEAR(estimate_sun_angle(image)->angle.value, before, 1e-3);
}

TEST(EstimateSunAngle, NoDirectionInNoise) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Pixels image(150, 150);
    Random random(seed);
    for (float& value : image.cells()) value = static_cast<float>(random.normal(100, 5));
    EXPECT_FALSE(estimate_sun_angle(image)) << "seed " << seed;
  }
}

TEST(EstimateSunAngle, NoneWithoutContrastOrPixels) {
  EXPECT_FALSE(estimate_sun_angle(Pixels(100, 100, 0)));
  EXPECT_FALSE(estimate_sun_angle(Pixels(1, 1, 9)));
  EXPECT_FALSE(estimate_sun_angle(Pixels()));
  EXPECT_FALSE(estimate_sun_angle(Pixels(64, 64, std::nanf(""))));
}

}  // namespace
}  // namespace waymark::test
