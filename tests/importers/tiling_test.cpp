// SPDX-License-Identifier: Apache-2.0
#include "importers/tiling.hpp"

#include <gmock/gmock.h>

namespace waymark::test {
namespace {

TEST(Tiling, RanksAlongTheCurveVisitSquares) {
  std::vector<pipeline::Tile> tiles = importers::tiles_of(35, 25, 10);
  importers::rank_along_curve(tiles);
  std::vector<std::int64_t> ranks;
  for (const pipeline::Tile& tile : tiles) ranks.push_back(tile.rank);
  EXPECT_THAT(ranks, testing::ElementsAre(0, 1, 4, 5,  //
                                          2, 3, 6, 7,  //
                                          8, 9, 10, 11));
}

}  // namespace
}  // namespace waymark::test
