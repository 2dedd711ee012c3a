// SPDX-License-Identifier: Apache-2.0
// Images of measured relief, and the verifier of craters that learns from them.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "pipeline/craters/relief_scene.hpp"
#include "pipeline/craters/relief_training.hpp"
#include "pipeline/craters/relief_verifier.hpp"

namespace waymark::test {
using namespace pipeline;
using ::testing::HasSubstr;
namespace {

constexpr int kSide = 160;

// A plain of 600 x 600 cells with paraboloid bowls at the knots of a lattice 60 cells wide, seen from
// latitude 60: columns are half as wide as rows, so each bowl covers twice as many columns.
CrateredRelief bowls_at_latitude_60() {
  CrateredRelief relief;
  relief.heights = Grid<float>(1200, 600, 0.0F);
  relief.cell_widths.assign(600, 0.5);
  for (int row = 30; row < 600; row += 60)
    for (int column = 60; column < 1200; column += 120) {
      const double diameter = 24, depth = 0.2 * diameter;
      relief.craters.push_back({double(column), double(row), diameter, 0.2});
      for (int y = -12; y <= 12; ++y)
        for (int x = -24; x <= 24; ++x)
          if (const double r = std::hypot(x * 0.5, y) / 12; r < 1)
            relief.heights(column + x, row + y) = static_cast<float>(depth * (r * r - 1));
    }
  return relief;
}

TEST(ReliefScene, LabelsLieOnTheBowlsOfTheImage) {
  const CrateredRelief relief = bowls_at_latitude_60();
  int clear = 0;
  double correlation = 0, shifted = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const LabelledScene scene = relief_scene(relief, seed, kSide);
    const PatchSource patches(scene.image, scene.sun_angle);
    for (const LabelledCrater& c : scene.craters)
      if (c.clarity == 1) {
        ++clear;
        correlation += patches.slope_correlation({c.x, c.y, c.diameter, 0});
        shifted += patches.slope_correlation({c.x + 0.5 * c.diameter, c.y, c.diameter, 0});
      }
  }
  ASSERT_GT(clear, 20);
  EXPECT_GT(correlation / clear, 0.7);  // 1: a bowl without albedo, blur, noise and cast shadows
  EXPECT_LT(shifted / clear, 0.4);
}

TEST(ReliefScene, SmallShallowAndCutCratersCountNeitherWay) {
  CrateredRelief relief = bowls_at_latitude_60();
  for (std::size_t i = 0; i < relief.craters.size(); ++i)
    (i % 2 == 0 ? relief.craters[i].diameter : relief.craters[i].depth_ratio) *= i % 2 == 0 ? 0.5 : 0.1;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const LabelledCrater& c : relief_scene(relief, seed, kSide).craters) EXPECT_EQ(c.clarity, 0.2);
}

TEST(ReliefScene, IsTheSameForASeed) {
  const CrateredRelief relief = bowls_at_latitude_60();
  EXPECT_EQ(relief_scene(relief, 3, kSide).image, relief_scene(relief, 3, kSide).image);
  EXPECT_FALSE(relief_scene(relief, 3, kSide).image == relief_scene(relief, 4, kSide).image);
}

TEST(ReliefVerifier, TextKeepsIt) {
  const std::string text = as_text(built_in_relief_verifier());
  EXPECT_EQ(as_text(parse_relief_verifier(text, "test")), text);
  EXPECT_EQ(built_in_relief_verifier().networks.size(), 3U);
  EXPECT_THAT(text, HasSubstr("300 images of 2 areas of measured relief"));
}

// The slow twin: odds by hand from the probabilities of each network.
TEST(ReliefVerifier, AveragesLogOddsForEvenPriors) {
  const ReliefVerifier& verifier = built_in_relief_verifier();
  CraterFeatures features{};
  for (std::size_t i = 0; i < features.size(); ++i)
    features[i] = static_cast<float>(std::sin(2.0 * double(i)));
  double sum = 0;
  for (const auto& network : verifier.networks) {
    const double p = predict(network, features).probability;
    sum += std::log(p / (1 - p) * (1 - verifier.prior) / verifier.prior);
  }
  EXPECT_NEAR(log_odds(verifier, features), sum / 3, 1e-9);
}

TEST(ReliefVerifier, SaysWhatIsWrongWithAFile) {
  const auto message = [](const std::string& text) {
    try {
      parse_relief_verifier(text, "v.txt");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(message("hello"), HasSubstr("it does not begin with 'waymark network 2 craters_in_relief'"));
  EXPECT_THAT(message(as_text(built_in_crater_model())), HasSubstr("v.txt"));
}

TEST(ReliefTraining, LearnsTheBowlsOfARelief) {
  const CrateredRelief relief = bowls_at_latitude_60();
  std::vector<CraterExample> examples;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const auto some = make_relief_examples(relief_scene(relief, seed, kSide), seed);
    examples.insert(examples.end(), some.begin(), some.end());
  }
  const auto craters = std::ranges::count_if(examples, &CraterExample::crater);
  ASSERT_GT(craters, 20);
  ASSERT_GT(std::ssize(examples), craters);
  const auto train = [&] { return train_relief_verifier(examples, {.rounds = 6}, 2, {}); };
  const ReliefVerifier verifier = train();
  EXPECT_EQ(as_text(verifier), as_text(train()));
  double of_craters = 0, of_others = 0;
  for (const CraterExample& example : examples)
    (example.crater ? of_craters : of_others) += log_odds(verifier, example.features);
  EXPECT_GT(of_craters / double(craters), of_others / double(std::ssize(examples) - craters) + 1);
  std::erase_if(examples, &CraterExample::crater);
  EXPECT_THROW(train_relief_verifier(examples, {}, 1, {}), std::logic_error);
}

}  // namespace
}  // namespace waymark::test
