// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/shadow_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <string_view>

#include "core/random.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

// Digits are tenths of shadow; the smoothed map is given, so that passes are exact.
ShadowMap shadow_art(std::string_view art) {
  std::vector<std::vector<float>> rows(1);
  for (const char letter : art) {
    if (letter == '\n' && !rows.back().empty()) rows.emplace_back();
    if (letter == '.' || (letter >= '0' && letter <= '9'))
      rows.back().push_back(letter == '.' ? 0.0F : 0.1F * static_cast<float>(letter - '0'));
  }
  if (rows.back().empty()) rows.pop_back();
  ShadowMap map;
  map.alpha = Grid<float>(static_cast<std::int64_t>(rows[0].size()), static_cast<std::int64_t>(rows.size()));
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < rows[y].size(); ++x)
      map.alpha(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)) = rows[y][x];
  map.smooth = map.alpha;
  return map;
}

TEST(FindSegments, TwoDarksWithADeepPassAreTwo) {
  const auto found = find_segments(shadow_art(R"(
    ...........
    .686..596..
    .797225a5..
    ...........
  )"),
                                   {});
  ASSERT_EQ(found.size(), 2U);
}

TEST(FindSegments, TwoDarksWithAShallowPassAreOne) {
  const auto found = find_segments(shadow_art(R"(
    ...........
    .68678696..
    .79787796..
    ...........
  )"),
                                   {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].cells.size(), 16U);
}

TEST(FindSegments, KeepsTheDarkHalfOfAShadowOnly) {
  const auto found = find_segments(shadow_art(R"(
    ..........
    ..23432...
    ..36863...
    ..23432...
    ..........
  )"),
                                   {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].x, 4);
  EXPECT_EQ(found[0].y, 2);
  EXPECT_EQ(found[0].cells.size(), 3U);  // 0.6 0.8 0.6: half of 0.8 is not above half
}

TEST(FindSegments, WeakOnesAreLeftOut) {
  EXPECT_TRUE(find_segments(shadow_art("....\n.11.\n....\n"), {}).empty());
  EXPECT_TRUE(find_segments(shadow_art("....\n....\n....\n"), {}).empty());
}

TEST(Smoothed, KeepsTheMeanAndSpreadsAPoint) {
  Grid<float> alpha(9, 9);
  alpha(4, 4) = 1;
  const Grid<float> smooth = smooth_alpha(alpha);
  EXPECT_FLOAT_EQ(smooth(4, 4), 16.0F / 36);
  EXPECT_FLOAT_EQ(smooth(3, 4), 4.0F / 36);
  EXPECT_FLOAT_EQ(smooth(3, 3), 1.0F / 36);
}

TEST(MapShadows, IsLinearInBrightness) {
  Pixels image(96, 96);
  Random random(5);
  for (float& value : image.cells()) value = static_cast<float>(random.normal(100, 1));
  for (std::int64_t k = 0; k < 6; ++k)
    for (std::int64_t y = 0; y < 5; ++y)
      for (std::int64_t x = 0; x < 5; ++x) image(10 + 14 * k + x, 30 + y) = 20;
  const auto map = map_shadows(image, 32);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->umbra, 20, 2);
  EXPECT_NEAR(map->alpha(12, 32), 1, 0.05);
  EXPECT_NEAR(map->alpha(60, 60), 0, 0.1);
  for (float& value : image.cells()) value = 1000 + 7 * value;
  const auto stretched = map_shadows(image, 32);
  ASSERT_TRUE(stretched);
  for (std::size_t i = 0; i < map->alpha.cells().size(); ++i)
    ASSERT_NEAR(stretched->alpha.cells()[i], map->alpha.cells()[i], 1e-3);
}

TEST(MapShadows, CountsThePixelsInShadow) {
  Pixels image(128, 96);
  Random random(6);
  for (float& value : image.cells()) value = static_cast<float>(random.normal(100, 1));
  for (std::int64_t y = 0; y < 96; ++y)
    for (std::int64_t x = 96; x < 128; ++x) image(x, y) -= 80;  // the last quarter
  for (std::int64_t x = 0; x < 128; ++x) image(x, 0) = std::nanf("");
  const auto map = map_shadows(image, 32);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->shaded.pixels, 128 * 95);
  EXPECT_EQ(map->shaded.shaded, 32 * 95);
  EXPECT_TRUE(map->shaded.is_much());
  ShadedGround sum = map->shaded;
  sum += {.pixels = 3 * 128 * 95, .shaded = 0};
  EXPECT_DOUBLE_EQ(sum.fraction(), 0.0625);
  EXPECT_FALSE(sum.is_much());
  EXPECT_DOUBLE_EQ(ShadedGround{}.fraction(), 0);
}

TEST(MapShadows, NothingWithoutContrast) {
  EXPECT_FALSE(map_shadows(Pixels(64, 64, 100), 32));
  EXPECT_FALSE(map_shadows(Pixels(64, 64, std::nanf("")), 32));
  EXPECT_FALSE(map_shadows(Pixels(2, 2, 1), 32));
}

}  // namespace
}  // namespace waymark::test
