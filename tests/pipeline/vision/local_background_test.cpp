// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/local_background.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Pixels noisy(std::int64_t columns, std::int64_t rows, double mean, double sd, double slope = 0) {
  Pixels image(columns, rows);
  Random random(7);
  for (std::int64_t y = 0; y < rows; ++y)
    for (std::int64_t x = 0; x < columns; ++x)
      image(x, y) = static_cast<float>(mean + slope * static_cast<double>(x) + random.normal(0, sd));
  return image;
}

float level_at(const LocalBackground& ground, std::int64_t x, std::int64_t y) {
  std::vector<float> level(static_cast<std::size_t>(ground.columns)), spread(level.size());
  ground.read_row(y, level, spread);
  return level[static_cast<std::size_t>(x)];
}

TEST(LocalBackground, FollowsASlopeOfBrightness) {
  const LocalBackground ground = local_background(noisy(256, 256, 50, 1, 0.5), 32);
  for (const std::int64_t x : {40, 100, 200})
    EXPECT_NEAR(level_at(ground, x, 128), 50 + 0.5 * static_cast<double>(x), 1.5);
}

TEST(LocalBackground, DoesNotSeeThingsSmallerThanATile) {
  Pixels image = noisy(128, 128, 100, 1);
  for (std::int64_t y = 60; y < 75; ++y)
    for (std::int64_t x = 60; x < 75; ++x) image(x, y) = 10;
  EXPECT_NEAR(level_at(local_background(image, 32), 67, 67), 100, 1);
}

TEST(LocalBackground, SpreadIsThatOfTheGround) {
  const LocalBackground ground = local_background(noisy(128, 128, 100, 5), 32);
  EXPECT_NEAR(ground.spread(1, 1), 5, 1);  // 256 samples: the deviation of a deviation is about 0.4
}

TEST(LocalBackground, FillsTilesWithoutDataFromTheirNeighbours) {
  Pixels image = noisy(160, 64, 100, 1);
  for (std::int64_t y = 0; y < 64; ++y)
    for (std::int64_t x = 0; x < 100; ++x) image(x, y) = kNan;
  EXPECT_NEAR(level_at(local_background(image, 32), 0, 0), 100, 1);
}

// Whole numbers, so that many samples are equal.
TEST(LocalBackground, LevelIsTheMedianOfTheSamples) {
  Pixels image = noisy(128, 128, 20, 3);
  for (float& value : image.cells()) value = std::round(value);
  std::vector<float> samples;  // every fourth of the 64 pixels about the tile (1, 1)
  for (std::int64_t y = 16; y < 80; y += 4)
    for (std::int64_t x = 16; x < 80; x += 4) samples.push_back(image(x, y));
  std::sort(samples.begin(), samples.end());
  EXPECT_EQ(local_background(image, 32).level(1, 1), samples[samples.size() / 2]);
}

TEST(LocalBackground, SpreadAtAPixelIsThatOfItsRow) {
  const LocalBackground ground = local_background(noisy(100, 70, 100, 5), 32);
  std::vector<float> level(100), spread(100);
  for (const std::int64_t y : {0, 20, 69}) {
    ground.read_row(y, level, spread);
    for (std::int64_t x = 0; x < 100; ++x)
      EXPECT_EQ(ground.spread_at(x, y), spread[static_cast<std::size_t>(x)]) << x << ", " << y;
  }
}

TEST(LocalBackground, OfNothingButNoDataIsNoData) {
  EXPECT_TRUE(std::isnan(level_at(local_background(Pixels(40, 40, kNan), 32), 5, 5)));
}

TEST(LocalBackground, TakesAnImageOfOnePixelAndOfNone) {
  EXPECT_TRUE(std::isnan(level_at(local_background(Pixels(1, 1, 5), 32), 0, 0)));  // too few for a median
  EXPECT_EQ(local_background(Pixels(), 32).level.columns(), 0);
}

TEST(NoiseSd, IsThatOfWhiteNoiseOnAnySlope) {
  EXPECT_NEAR(noise_sd(noisy(200, 200, 100, 3)), 3, 0.1);
  EXPECT_NEAR(noise_sd(noisy(200, 200, 100, 3, 2)), 3, 0.1);
  EXPECT_NEAR(noise_sd(noisy(2000, 600, 100, 3)), 3, 0.1);
}

TEST(NoiseSd, IgnoresFewBrightThings) {
  Pixels image = noisy(200, 200, 100, 3);
  for (std::int64_t i = 0; i < 200; i += 10) image(i, i) = 1000;
  EXPECT_NEAR(noise_sd(image), 3, 0.15);
}

TEST(NoiseSd, IsZeroWhereNothingCanBeMeasured) {
  EXPECT_EQ(noise_sd(Pixels(2, 9)), 0);
  EXPECT_EQ(noise_sd(Pixels(9, 9, kNan)), 0);
}

}  // namespace
}  // namespace waymark::test
