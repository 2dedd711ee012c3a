// SPDX-License-Identifier: Apache-2.0
// Bias of rock positions along the light, on scenes that nothing was fitted to. The figures are those of
// docs/evaluation/2026-11-23-boulders-and-rock-biases.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/position_bias.hpp"
#include "tests/pipeline/rocks/rock_score.hpp"
#include "tests/support/seed_offset.hpp"
namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

// Mean error away from the sun of rocks below and above 8 px, pixels.
struct AlongBias {
  double small = 0, large = 0;
};

AlongBias along_bias(const RockScore& score) {
  double sum[2] = {}, count[2] = {};
  for (int bin = 0; bin < RockScore::kBins; ++bin)
    for (const double error : score.along_errors[bin]) sum[bin == 3] += error, ++count[bin == 3];
  return {sum[0] / std::max(1.0, count[0]), sum[1] / std::max(1.0, count[1])};
}

class RockPosition : public ::testing::TestWithParam<double> {};

TEST_P(RockPosition, HasNoBiasAlongTheLight) {
  using Shape = RockScene::Shape;
  constexpr Shape kShapes[] = {Shape::ellipsoid, Shape::irregular, Shape::mixed};
  RockScore score;
  for (int k = 0; k < 6; ++k) {
    const RockScene scene{.columns = 192,
                          .rows = 192,
                          .incidence = {GetParam()},
                          .sun_angle = {25 + 60.0 * k},
                          .shape = kShapes[k % 3],
                          .cover = 0.05,
                          .min_diameter = 3,
                          .blur = 0.4 + 0.12 * k,
                          .seed = static_cast<std::uint64_t>(7200 + k + 10 * GetParam()) + seed_offset()};
    const RockImage image = render(scene);
    const Radians sun = to_radians(scene.sun_angle);
    const RockSearch search{.sun_angle = sun, .sun_elevation = to_radians(Degrees{90 - GetParam()})};
    score.add(image, find_rocks(image.pixels, search), sun.value);
  }
  const AlongBias bias = along_bias(score);
  std::printf("incidence %g: %+.3f px, above 8 px %+.3f px\n", GetParam(), bias.small, bias.large);
  EXPECT_LT(std::abs(bias.small), 0.15);
  EXPECT_LT(std::abs(bias.large), 0.3);
}

INSTANTIATE_TEST_SUITE_P(Sun, RockPosition, ::testing::Values(25.0, 37.0, 50.0, 63.0, 74.0));

// Beyond the data of the fit the bias is that of the nearest data, in proportion to the size of the rock.
TEST(PositionBias, IsNotExtrapolated) {
  const auto bias = [](double tan_elevation, double displacement) {
    return position_bias(
        {.radius = 3, .height = 3, .tan_elevation = tan_elevation, .displacement = displacement});
  };
  EXPECT_EQ(bias(0.25, 0), bias(0.05, 0));
  EXPECT_EQ(bias(2, 0), bias(50, 0));
  EXPECT_EQ(bias(1, 2), bias(1, 9));
  EXPECT_GT(bias(1, 0.5), bias(1, -0.5));
}

}  // namespace
}  // namespace waymark::test
