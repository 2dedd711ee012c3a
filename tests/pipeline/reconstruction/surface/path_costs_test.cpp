// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/path_costs.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>

#include "core/random.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// Hirschmueller 2008, eq. 13, by recursion along one direction.
int path_cost(const CostVolume& v, const PathPenalties& p, int column, int row, int k, int dx, int dy) {
  const int own = v.cost[v.at(column, row) + static_cast<std::size_t>(k)];
  const int c = column - dx, r = row - dy;
  if (c < 0 || r < 0 || c >= v.columns || r >= v.rows) return own;
  int best = 1 << 20, least = 1 << 20;
  for (int from = 0; from < v.steps; ++from) {
    const int before = path_cost(v, p, c, r, from, dx, dy);
    const int change = std::abs(from - k);
    best = std::min(best, before + (change == 0 ? 0 : change == 1 ? p.small : p.large));
    least = std::min(least, before);
  }
  return own + best - least;
}

TEST(PathCosts, MatchTheRecursion) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    CostVolume volume{.columns = 5, .rows = 4, .steps = 3};
    for (int i = 0; i < 5 * 4 * 3; ++i)
      volume.cost.push_back(static_cast<std::uint8_t>(random.uniform() * 128));
    const PathPenalties penalties{.small = 4, .large = 24};
    const std::vector<std::uint16_t> total = sum_path_costs(volume, penalties);
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 5; ++c)
        for (int k = 0; k < 3; ++k) {
          int sum = 0;
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              if (dx != 0 || dy != 0) sum += path_cost(volume, penalties, c, r, k, dx, dy);
          ASSERT_EQ(total[volume.at(c, r) + static_cast<std::size_t>(k)], sum) << "seed " << seed;
        }
  }
}

TEST(PathCosts, CarryANodeWithoutEvidence) {
  CostVolume volume{.columns = 3, .rows = 1, .steps = 4};
  volume.cost = {9, 9, 0, 9, 5, 5, 5, 5, 9, 9, 0, 9};
  const auto total = sum_path_costs(volume, {.small = 1, .large = 8});
  const auto middle = total.begin() + 4;
  EXPECT_EQ(std::min_element(middle, middle + 4) - middle, 2);
}

}  // namespace
}  // namespace waymark::test
