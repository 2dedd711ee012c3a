// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/outlying_images.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/fusion/made_landing.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// Views of pairs of `images` images: 50 each, but 1 where an image is `bad`.
Repetition views_of(std::uint32_t images, const std::vector<std::uint32_t>& bad) {
  Repetition seen{.expected = 0, .raw = 0, .chance = 0.02, .pairs = {}};
  for (std::uint32_t a = 0; a < images; ++a)
    for (std::uint32_t b = 0; b < images; ++b) {
      if (a == b) continue;
      const bool wrong = std::ranges::count(bad, a) + std::ranges::count(bad, b) > 0;
      seen.pairs.push_back({.from = a, .to = b, .expected = 50, .matched = wrong ? 1U : 45U});
    }
  return seen;
}

TEST(OutlyingImages, AreThoseThatFitNoOther) {
  EXPECT_TRUE(find_outlying_images(views_of(6, {})).images.empty());
  const OutlyingImages one = find_outlying_images(views_of(6, {4}));
  ASSERT_EQ(one.images.size(), 1U);
  EXPECT_EQ(one.images[0].image, 4U);
  EXPECT_EQ(one.images[0].expected, 500U);
  EXPECT_NEAR(one.images[0].raw, 0.02, 1e-12);
  EXPECT_NEAR(one.rest, 0.9, 1e-12);
  EXPECT_EQ(find_outlying_images(views_of(7, {1, 5})).images.size(), 2U);
}

TEST(OutlyingImages, AreNoneWhereTheMajorityIsUnknown) {
  EXPECT_TRUE(find_outlying_images(views_of(2, {1})).images.empty());
  EXPECT_TRUE(find_outlying_images(views_of(3, {1})).images.empty());  // which two agree may be chance
  EXPECT_TRUE(find_outlying_images(views_of(6, {0, 1, 2, 3, 4, 5})).images.empty());
  EXPECT_TRUE(find_outlying_images({}).images.empty());
  Repetition few = views_of(6, {4});
  for (ImagePair& pair : few.pairs) pair.expected /= 50, pair.matched /= 50;
  EXPECT_TRUE(find_outlying_images(few).images.empty());
}

TEST(OutlyingImages, AnImage15MetresOffIsNamed) {
  for (const std::int64_t seed : {61, 62}) {
    testbed::Scenario scenario;
    scenario.seed = seed;
    scenario.ground.width = scenario.ground.height = 0;
    scenario.ground.cell = 1;
    scenario.ground.rocks.k = 0.08;
    scenario.lens.columns = scenario.lens.rows = 500;
    scenario.flights.front().images = 8;
    scenario.pose_errors = {0.1, Degrees{0.02}};
    MadeLanding made = made_landing(scenario);
    EXPECT_TRUE(
        find_outlying_images(measure_repetition(made.observations, made.images, made.types, Crs::local()))
            .images.empty());
    ImageView& off = made.images.at(3);
    off.view->grid_from_camera.transform.translation().x() += 15;
    for (Observation& o : made.observations)
      if (o.source == off.name) o.position.xyz.x() += 15;
    const OutlyingImages found =
        find_outlying_images(measure_repetition(made.observations, made.images, made.types, Crs::local()));
    ASSERT_EQ(found.images.size(), 1U) << seed;
    EXPECT_EQ(found.images[0].image, 3U) << seed;
    EXPECT_GT(found.rest, 0.7) << seed;
  }
}

}  // namespace
}  // namespace waymark::test
