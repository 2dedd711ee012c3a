// SPDX-License-Identifier: Apache-2.0
#include "core/grid.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
namespace {

TEST(Grid, RowsAreContiguousAndColumnsComeFirst) {
  Grid<int> grid(3, 2, 7);
  grid(2, 1) = 9;
  EXPECT_EQ(grid.row(1)[2], 9);
  EXPECT_EQ(grid.cells()[5], 9);
  EXPECT_EQ(grid.cells()[0], 7);
}

TEST(Grid, AtSaysWhichCellIsOutside) {
  const Grid<int> grid(3, 2);
  EXPECT_NO_THROW(grid.at(2, 1));
  try {
    grid.at(3, 0);
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "cell (3, 0) is outside a grid of 3 x 2");
  }
}

TEST(Window, ContainsItsFirstCellAndNotItsEnd) {
  const Window window{10, 20, 5, 4};
  EXPECT_TRUE(window.contains(10, 20));
  EXPECT_TRUE(window.contains(14, 23));
  EXPECT_FALSE(window.contains(15, 23));
  EXPECT_EQ(window.cells(), 20);
}

}  // namespace
}  // namespace waymark::test
