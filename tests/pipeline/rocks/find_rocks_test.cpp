// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/find_rocks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"
#include "pipeline/rocks/find_classic_rocks.hpp"
#include "tests/pipeline/rocks/rock_score.hpp"
namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

using ::testing::HasSubstr;

const RockScene kField{.columns = 160,
                       .rows = 144,
                       .shape = RockScene::Shape::mixed,
                       .cover = 0.04,
                       .max_diameter = 8,
                       .seed = 5};

const RockImage& field() {
  static const RockImage image = render(kField);
  return image;
}

RockSearch search_of(const RockScene& scene) {
  return {.sun_angle = to_radians(scene.sun_angle),
          .sun_elevation = to_radians(Degrees{90 - scene.incidence.value})};
}

std::string message(const RockSearch& search) {
  try {
    find_rocks(Pixels(8, 8), search);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(FindRocks, FindsThemWithAndWithoutKnownSun) {
  RockScore known, guessed;
  const double sun = to_radians(RockScene{}.sun_angle).value;
  known.add(field(), find_rocks(field().pixels, search_of({})), sun);
  guessed.add(field(), find_rocks(field().pixels, {}), sun);
  EXPECT_GE(known.recall(1), 0.9);
  EXPECT_GE(known.precision(), 0.9);
  EXPECT_GE(guessed.recall(1), 0.85);
  EXPECT_GE(guessed.precision(), 0.85);
}

// Rotating image and light by a quarter turn rotates the rocks.
TEST(FindRocks, TurnsWithTheImage) {
  const Pixels& image = field().pixels;
  Pixels turned(image.rows(), image.columns());  // (x, y) -> (rows - 1 - y, x)
  for (std::int64_t y = 0; y < image.rows(); ++y)
    for (std::int64_t x = 0; x < image.columns(); ++x) turned(image.rows() - 1 - y, x) = image(x, y);
  RockSearch search = search_of({});
  const auto before = find_rocks(image, search);
  search.sun_angle = Radians{search.sun_angle->value + std::numbers::pi / 2};
  const auto after = find_rocks(turned, search);
  std::size_t same = 0;
  for (const Detection& a : before)
    for (const Detection& b : after)
      same += std::hypot(b.outline.x - (static_cast<double>(image.rows() - 1) - a.outline.y),
                         b.outline.y - a.outline.x) < 0.5;
  // Tiles of the background start at another corner, so a few rocks may differ.
  EXPECT_GE(static_cast<double>(same), 0.85 * static_cast<double>(std::max(before.size(), after.size())));
}

TEST(FindRocks, DoesNotDependOnTheUnitOfBrightness) {
  Pixels image = field().pixels;
  const auto before = find_rocks(image, search_of({}));
  for (float& value : image.cells()) value = 200 + 250 * value;  // as 16-bit files have it
  const auto after = find_rocks(image, search_of({}));
  ASSERT_NEAR(static_cast<double>(after.size()), static_cast<double>(before.size()), 1);
  EXPECT_NEAR(after[0].outline.x, before[0].outline.x, 0.05);
}

TEST(FindRocks, SameTwice) {
  EXPECT_EQ(find_rocks(field().pixels, search_of({})), find_rocks(field().pixels, search_of({})));
}

TEST(FindRocks, NoDataIsNoRock) {
  Pixels image = field().pixels;
  for (std::int64_t y = 0; y < 70; ++y)
    for (std::int64_t x = 0; x < image.columns(); ++x) image(x, y) = std::numeric_limits<float>::quiet_NaN();
  for (const Detection& rock : find_rocks(image, search_of({}))) {
    EXPECT_GT(rock.outline.y, 66);
    EXPECT_TRUE(std::isfinite(rock.outline.x) && std::isfinite(rock.outline.diameter()));
  }
}

TEST(FindRocks, EverythingItSaysIsANumber) {
  for (const RockMethod method : {RockMethod::shadow, RockMethod::classic}) {
    RockSearch search = search_of({});
    search.method = method;
    search.min_confidence = 0;
    search.type = 3;
    for (const Detection& rock : find_rocks(field().pixels, search)) {
      EXPECT_EQ(rock.type, 3);
      EXPECT_GT(rock.outline.minor, 0);
      EXPECT_GT(rock.covariance.determinant(), 0);
      EXPECT_GT(rock.diameter_sd, 0);
      ASSERT_TRUE(rock.shadow_reach);
      EXPECT_GT(rock.shadow_reach->value, 0);
      EXPECT_GT(rock.shadow_reach->sd, 0);
      EXPECT_GT(rock.confidence, 0);
      EXPECT_LE(rock.confidence, 1);
    }
  }
}

// Measured quantities respond fully to a slope, those that depend on the prior of rocks in part.
TEST(FindRocks, TellsHowFarSizesFollowSlopes) {
  RockSearch search = search_of(kField);
  const auto leaning = find_rocks(field().pixels, search);
  search.method = RockMethod::classic;
  const auto measured = find_rocks(field().pixels, search);
  ASSERT_FALSE(leaning.empty());
  ASSERT_FALSE(measured.empty());
  EXPECT_EQ(leaning.front().reach_slope_response, 0.4);
  EXPECT_EQ(leaning.front().diameter_slope_response, 0.2);
  EXPECT_EQ(measured.front().reach_slope_response, 1);
  EXPECT_EQ(measured.front().diameter_slope_response, 0);
}

TEST(FindRocks, ImagesWithoutRocksHaveNone) {
  for (const RockMethod method : {RockMethod::shadow, RockMethod::classic})
    for (const std::optional<Radians> sun : {std::optional<Radians>{}, std::optional<Radians>{Radians{1}}}) {
      RockSearch search{.method = method, .sun_angle = sun};
      EXPECT_TRUE(find_rocks(Pixels(), search).empty());
      EXPECT_TRUE(find_rocks(Pixels(1, 1, 7), search).empty());
      EXPECT_TRUE(find_rocks(Pixels(3, 200, 7), search).empty());
      EXPECT_TRUE(find_rocks(Pixels(100, 100, 0), search).empty());              // black
      EXPECT_TRUE(find_rocks(Pixels(100, 100, 255), search).empty());            // blown out
      EXPECT_TRUE(find_rocks(Pixels(100, 100, std::nanf("")), search).empty());  // no data
    }
}

TEST(FindRocks, RefusesASunThatCastsNoShadow) {
  EXPECT_THAT(message({.sun_elevation = Radians{-0.1}}), HasSubstr("not above the horizon"));
  EXPECT_THAT(message({.sun_elevation = Radians{-0.1}}), HasSubstr("check the frame"));
  EXPECT_THAT(message({.sun_elevation = Radians{1.6}}), HasSubstr("below 90 degrees"));
  EXPECT_THAT(message({.sun_angle = Radians{std::nan("")}}), HasSubstr("not a number"));
}

TEST(FindRocks, RefusesNumbersOutOfRange) {
  EXPECT_THAT(message({.min_diameter = 5, .max_diameter = 2}), HasSubstr("diameters from 5 to 2 pixels"));
  EXPECT_THAT(message({.min_confidence = 1.5}), HasSubstr("min_confidence is 1.5"));
  EXPECT_THAT(message({.blur = -1}), HasSubstr("blur is -1 pixels"));
}

TEST(MaximumEntropyThreshold, PartsTwoClasses) {
  std::vector<double> histogram(256, 0);
  for (int i = 20; i < 40; ++i) histogram[static_cast<std::size_t>(i)] = 10;
  for (int i = 150; i < 200; ++i) histogram[static_cast<std::size_t>(i)] = 100;
  const int threshold = maximum_entropy_threshold(histogram);
  EXPECT_GE(threshold, 39);
  EXPECT_LT(threshold, 150);
  EXPECT_EQ(maximum_entropy_threshold(std::vector<double>(256, 0)), 0);
}

}  // namespace
}  // namespace waymark::test
