// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/neighbourhood.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace waymark::test {
using namespace pipeline;
namespace {

std::uint8_t mask(std::initializer_list<int> bits) {
  unsigned all = 0;
  for (const int bit : bits) all |= 1u << bit;
  return static_cast<std::uint8_t>(all);
}

int parts(std::uint8_t m) {
  return std::popcount(connected_parts(m));
}

TEST(Neighbourhood, CountsConnectedParts) {
  EXPECT_EQ(parts(mask({})), 0);
  EXPECT_EQ(parts(mask({0, 1, 2})), 1);     // north to east
  EXPECT_EQ(parts(mask({0, 2})), 1);        // north and east touch by a corner
  EXPECT_EQ(parts(mask({1, 3})), 2);        // north-east and south-east do not
  EXPECT_EQ(parts(mask({0, 4})), 2);        // north and south
  EXPECT_EQ(parts(mask({1, 3, 5, 7})), 4);  // the corners
  EXPECT_EQ(parts(mask({0, 2, 4, 6})), 1);  // the edges, a ring
  EXPECT_EQ(parts(0xff), 1);
}

TEST(Neighbourhood, ThePartsDoNotDependOnWhereTheRingBegins) {
  for (unsigned m = 0; m < 256; ++m) {
    const unsigned quarter_turn = (m << 2 | m >> 6) & 0xff;
    EXPECT_EQ(parts(static_cast<std::uint8_t>(m)), parts(static_cast<std::uint8_t>(quarter_turn))) << m;
  }
}

TEST(Neighbourhood, EarlierCellsWinTies) {
  const double rows[3][3] = {{5, 5, 5}, {5, 5, 5}, {5, 5, 5}};
  std::uint8_t masks[1];
  higher_neighbours(&rows[0][1], &rows[1][1], &rows[2][1], masks);
  EXPECT_EQ(masks[0], mask({0, 1, 6, 7}));  // north, north-east, west, north-west
}

}  // namespace
}  // namespace waymark::test
