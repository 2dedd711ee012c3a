// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/run/work_division.hpp"

#include <gmock/gmock.h>

#include <set>

namespace waymark::test {
using namespace pipeline;
namespace {

/// Two stages over the same tiles, which run column by column.
Plan tiled_plan(std::int64_t columns, std::int64_t rows) {
  Plan plan;
  for (const char* stage : {"first", "second"}) {
    for (std::int64_t i = 0; i < columns * rows; ++i)
      plan.units.push_back(
          Unit{.stage = stage,
               .item = "tile_" + std::to_string(i),
               .tile = Tile{i, i % columns, i / columns, {}, i % columns * rows + i / columns},
               .image = {},
               .fingerprint = {},
               .after = {}});
    plan.begins.push_back(plan.units.size());
  }
  return plan;
}

/// Returns the units that one of `count` shards runs, as indices of tiles of the stage.
std::set<std::int64_t> tiles_of(const Plan& plan, int index, int count, const std::string& stage) {
  std::vector<UnitState> states(plan.units.size());
  divide_work(plan, {.work = "work", .shard = Shard{index, count}, .stage = stage}, states);
  std::set<std::int64_t> tiles;
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].assignment == UnitAssignment::own) {
      EXPECT_EQ(plan.units[i].stage, stage);
      tiles.insert(plan.units[i].tile->index);
    }
  return tiles;
}

TEST(WorkDivision, TilesRunByRankAndThoseOfAShardAreNeighbours) {
  const Plan plan = tiled_plan(3, 2);
  for (const std::size_t stage : {std::size_t{0}, std::size_t{1}})
    EXPECT_THAT(run_order(plan, stage), testing::ElementsAre(0, 3, 1, 4, 2, 5));
  EXPECT_THAT(tiles_of(plan, 1, 3, "first"), testing::ElementsAre(0, 3));
  EXPECT_THAT(tiles_of(plan, 2, 3, "second"), testing::ElementsAre(1, 4));
}

TEST(WorkDivision, EachTileIsInOneShardAndShardsAreEqual) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 7}, {5, 3}, {9, 4}, {13, 11}})
    for (const int count : {1, 2, 3, 7, 64, 200}) {
      const Plan plan = tiled_plan(columns, rows);
      std::size_t all = 0, smallest = plan.units.size(), largest = 0;
      std::set<std::int64_t> seen;
      for (int index = 1; index <= count; ++index) {
        const auto tiles = tiles_of(plan, index, count, "first");
        all += tiles.size(), smallest = std::min(smallest, tiles.size()),
                             largest = std::max(largest, tiles.size());
        seen.insert(tiles.begin(), tiles.end());
      }
      EXPECT_EQ(all, static_cast<std::size_t>(columns * rows));
      EXPECT_EQ(seen.size(), all);
      EXPECT_LE(largest - smallest, 1U) << columns << " x " << rows << ", " << count;
    }
}

}  // namespace
}  // namespace waymark::test
