// SPDX-License-Identifier: Apache-2.0
#include "workflows/forest/stand_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark::test {
namespace {

TEST(AirRecall, WideCrownsHideMore) {
  for (std::size_t row = 0; row < 5; ++row) {
    double before = 1;
    for (const double share : {0.194, 0.22, 0.246, 0.27, 0.295}) {
      const double found = workflows::airborne_recall(25, share).at(row).recall;
      EXPECT_LT(found, before) << row << " " << share;
      EXPECT_GT(found, 0.1);
      before = found;
    }
  }
}

TEST(AirRecall, IsThatOfTheNearestBeyondWhatWasMade) {
  for (const auto& [beyond, nearest] : {std::pair(0.05, 0.194), {0.9, 0.295}})
    for (std::size_t row = 0; row < 5; ++row) {
      EXPECT_EQ(workflows::airborne_recall(20, beyond).at(row).recall,
                workflows::airborne_recall(20, nearest).at(row).recall);
      EXPECT_EQ(workflows::airborne_recall(20, beyond).at(row).sd,
                workflows::airborne_recall(20, nearest).at(row).sd);
    }
}

TEST(AirRecall, LiesHalfwayBetweenTwoKinds) {
  const auto rows = workflows::airborne_recall(20, (0.246 + 0.295) / 2);
  EXPECT_NEAR(rows.at(0).recall, (0.31 + 0.16) / 2, 1e-12);
  EXPECT_NEAR(rows.at(3).height_from, 16, 1e-12);
}

TEST(AirRecall, NeedsHeightsAndCrowns) {
  EXPECT_TRUE(workflows::airborne_recall(std::nan(""), 0.2).empty());
  EXPECT_TRUE(workflows::airborne_recall(0, 0.2).empty());
  EXPECT_TRUE(workflows::airborne_recall(20, std::nan("")).empty());
  EXPECT_TRUE(workflows::airborne_recall(20, 0).empty());
}

}  // namespace
}  // namespace waymark::test
