// SPDX-License-Identifier: Apache-2.0
#include "planning/relief_row.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace waymark::test {
namespace {

using namespace planning;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<BaseRelief> random_relief(unsigned seed, std::size_t cells) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<BaseRelief> all;
  while (all.size() < cells) {
    const float scale = std::exp2(8 * uniform(random) - 6);
    BaseRelief relief{scale * (uniform(random) - 0.5F), scale * (uniform(random) - 0.5F),
                      0.2F * scale * uniform(random), 0.6F * scale * uniform(random)};
    const float kind = uniform(random);
    if (kind < 0.05F) relief = {kNan, kNan, kNan, kNan};
    if (kind > 0.95F) relief = {0, 0, 0, 0};
    if (kind > 0.90F && kind < 0.93F) relief.roughness = 0;
    all.push_back(relief);
  }
  return all;
}

TEST(ReliefRow, HasTheBitsOfSingleCells) {
  const Vehicle vehicle = find_vehicle("rover");
  const BaseFootprint base = make_base_footprint(0.5, 0.4, 1.2, 0.5);
  std::int64_t hazards = 0, safe = 0, between = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const HeightErrors errors{.sd = seed % 3 * 0.015, .correlation = seed % 2 * 2.0};
    const FitErrors fit = propagate_errors(base, errors);
    const std::size_t cells = 1 + seed * 7;
    const std::vector<BaseRelief> relief = random_relief(seed, cells);
    std::vector<std::vector<float>> bands(6, std::vector<float>(cells, -1));
    ReliefRow row(fit, vehicle);
    const auto probability = row.assess(relief, {bands[0], bands[1], bands[2], bands[3], bands[4], bands[5]});
    ASSERT_EQ(probability.size(), cells);
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    for (std::size_t i = 0; i < cells; ++i) {
      if (std::isnan(relief[i].step)) {
        for (const auto& band : bands) EXPECT_EQ(bits(band[i]), bits(kNan));
        continue;
      }
      const ReliefHazard one = assess_relief(relief[i], fit, vehicle);
      const double expected[] = {one.slope.value,  one.slope.sd,   one.roughness.value,
                                 one.roughness.sd, one.step.value, one.step.sd};
      for (std::size_t b = 0; b < bands.size(); ++b)
        ASSERT_EQ(bits(bands[b][i]), bits(static_cast<float>(expected[b])))
            << "seed " << seed << " band " << b;
      ASSERT_EQ(probability[i], one.probability) << "seed " << seed << " cell " << i;
      (one.probability == 0 ? safe : one.probability == 1 ? hazards : between) += 1;
    }
  }
  EXPECT_GT(std::min({hazards, safe, between}), 500);
}

}  // namespace
}  // namespace waymark::test
