// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/spot_context.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// By the definition: the squares within one of the spot's own.
SpotContext slow_context(const std::vector<DarkSpot>& spots, const DarkSpot& about, double pixels) {
  std::vector<double> peaks;
  for (const DarkSpot& s : spots)
    if (std::abs(std::floor(s.x / 96) - std::floor(about.x / 96)) <= 1 &&
        std::abs(std::floor(s.y / 96) - std::floor(about.y / 96)) <= 1)
      peaks.push_back(s.peak);
  std::sort(peaks.begin(), peaks.end());
  const auto at = [&](double fraction) {
    return peaks[static_cast<std::size_t>(fraction * double(peaks.size() - 1))];
  };
  return {at(0.5), at(0.9), 1000 * double(peaks.size()) / pixels};
}

TEST(SpotContext, IsWhatItsDefinitionSays) {
  Random random(1, "spots");
  std::vector<DarkSpot> spots;
  for (int i = 0; i < 3000; ++i)
    spots.push_back({random.uniform(0, 960), random.uniform(0, 480), random.uniform()});
  const auto fast = spot_contexts(spots, 960, 480);
  ASSERT_EQ(fast.size(), spots.size());
  for (std::size_t i = 0; i < spots.size(); i += 37) {
    const auto count = [](double at, int all) {
      const int own = static_cast<int>(at) / 96;
      return std::min(own + 1, all - 1) - std::max(own - 1, 0) + 1;
    };
    const double pixels = 96.0 * 96 * count(spots[i].x, 10) * count(spots[i].y, 5);
    const SpotContext slow = slow_context(spots, spots[i], pixels);
    EXPECT_EQ(fast[i].median_peak, slow.median_peak);
    EXPECT_EQ(fast[i].upper_decile, slow.upper_decile);
    EXPECT_NEAR(fast[i].density, slow.density, 1e-12);
  }
}

TEST(SpotContext, FewSpotsAreJudgedByAll) {
  const std::vector<DarkSpot> spots{{5, 5, 0.2}, {900, 5, 0.4}, {450, 5, 0.6}};
  const auto contexts = spot_contexts(spots, 960, 96);
  for (const SpotContext& c : contexts) EXPECT_EQ(c.median_peak, 0.4);
  EXPECT_TRUE(spot_contexts({}, 10, 10).empty());
}

}  // namespace
}  // namespace waymark::test
